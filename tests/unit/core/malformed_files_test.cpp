// Other projects' regression and fuzz inputs (../shared/malformed): OBJ, glTF 1.0, EXR and PNG.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/image_io.h"
#include "core/scene/load.h"
#include "tests/shared_folder.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;

template <class Action>
std::string refusal(Action&& action) {
  try {
    action();
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

std::vector<fs::path> filesIn(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && (extension.empty() || entry.path().extension() == extension))
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Malformed, TinyobjloadersModelsLoadUnlessTheyShowNothing) {
  SACCADE_SHARED_FILE(folder, "malformed/tinyobjloader");
  // Points, lines, no geometry at all, or only faces with indices that are not there.
  const std::set<std::string> nothing = {"invalid-face-definition.obj",
                                         "invalid-relative-texture-index.obj",
                                         "invalid-relative-vertex-index.obj",
                                         "issue-356-leading-spaces-newmtl.obj",
                                         "line-prim.obj",
                                         "points-prim.obj"};
  const auto files = filesIn(folder, ".obj");
  EXPECT_GT(files.size(), 40u);
  for (const fs::path& file : files) {
    const std::string why = refusal([&] { loadScene(file, {}); });
    if (nothing.contains(file.filename().string())) {
      EXPECT_NE(why.find("holds no triangle to show"), std::string::npos) << file << why;
    } else {
      EXPECT_EQ(why, "") << file;
    }
  }
}

TEST(Malformed, CgltfsFuzzSeedsGiveASceneOrARefusal) {
  SACCADE_SHARED_FILE(folder, "malformed/cgltf/fuzz/data");
  for (const fs::path& file : filesIn(folder, "")) {
    const std::string why = refusal([&] { loadScene(file, {}); });
    if (file.filename() == "Box.glb" || file.filename() == "TriangleWithoutIndices.gltf") {
      EXPECT_EQ(why, "") << file;
    } else {
      EXPECT_NE(why, "") << file;  // texture extension alone; a buffer that is not beside it
    }
  }
}

TEST(Malformed, Gltf1IsRefusedByItsVersion) {
  SACCADE_SHARED_FILE(folder, "malformed/gltf1");
  const auto files = filesIn(folder, ".gltf");
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files) {
    const std::string why = refusal([&] { loadScene(file, {}); });
    EXPECT_NE(why.find("version is '1.0'; only glTF 2.x is read"), std::string::npos) << file << why;
  }
}

TEST(Malformed, TinyexrsFilesAreReadOrRefused) {
  SACCADE_SHARED_FILE(folder, "malformed/tinyexr");
  for (const fs::path& file : filesIn(folder, "")) {
    const std::string why = refusal([&] { readExr(file); });
    if (file.filename().string().starts_with("poc-")) {
      EXPECT_NE(why, "") << file;
    }
  }
  EXPECT_EQ(refusal([&] { readExr(folder / "2by2.exr"); }), "");
  EXPECT_EQ(refusal([&] { readExr(folder / "flaga.exr"); }), "");
  EXPECT_NE(refusal([&] { readExr(folder / "piz-bug-issue-100.exr"); }).find("compression"),
            std::string::npos);
  EXPECT_NE(refusal([&] { readExr(folder / "tiled_half_1x1_alpha.exr"); }).find("tiled"), std::string::npos);
}

TEST(Malformed, PngSuiteDecodesButForItsCorruptFiles) {
  SACCADE_SHARED_FILE(folder, "malformed/pngsuite");
  const auto corrupt = filesIn(folder / "corrupt", ".png");
  EXPECT_EQ(corrupt.size(), 14u);
  for (const fs::path& file : corrupt) EXPECT_NE(refusal([&] { readImage8(file); }), "") << file;
  for (const char* part : {"primary", "16bit"})
    for (const fs::path& file : filesIn(folder / part, ".png"))
      EXPECT_EQ(refusal([&] { readImage8(file); }), "") << file;
}

TEST(Malformed, PngSuitesPairsShowTheSamePicture) {
  SACCADE_SHARED_FILE(folder, "malformed/pngsuite");
  const auto pixels = [&](const std::string& name) { return readImage8(folder / name).pixels(); };
  // The same picture interlaced, for every colour type and depth, 16 bits and palettes included.
  for (const char* type :
       {"0g01", "0g02", "0g04", "0g08", "2c08", "3p01", "3p02", "3p04", "3p08", "4a08", "6a08"})
    EXPECT_EQ(pixels(std::string("primary/basn") + type + ".png"),
              pixels(std::string("primary/basi") + type + ".png"))
        << type;
  for (const char* type : {"0g16", "2c16", "4a16", "6a16"})
    EXPECT_EQ(pixels(std::string("16bit/basn") + type + ".png"),
              pixels(std::string("16bit/basi") + type + ".png"))
        << type;
  for (const char* size : {"01", "02", "03", "04", "32", "33", "39", "40"}) {
    const std::string depth = size[0] < '3' ? "3p01.png" : "3p04.png";
    EXPECT_EQ(pixels(std::string("primary/s") + size + "n" + depth),
              pixels(std::string("primary/s") + size + "i" + depth))
        << size;
  }
  // The data in several chunks; other compression; a background, which is not ours to apply.
  for (const char* chunks : {"oi2", "oi4", "oi9"})
    for (const char* type : {"n0g16.png", "n2c16.png"})
      EXPECT_EQ(pixels(std::string("16bit/") + chunks + type), pixels(std::string("16bit/oi1") + type));
  for (const char* level : {"z03", "z06", "z09"})
    EXPECT_EQ(pixels(std::string("primary/") + level + "n2c08.png"), pixels("primary/z00n2c08.png"));
  EXPECT_EQ(pixels("16bit/bggn4a16.png"), pixels("16bit/basn4a16.png"));
  EXPECT_EQ(pixels("primary/bgwn6a08.png"), pixels("primary/basn6a08.png"));
}

}  // namespace
}  // namespace saccade::core
