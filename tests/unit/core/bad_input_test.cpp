// Hostile and broken scene files: each ends in one clear line or in a repair that is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/scene/loaders.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using nlohmann::json;
using saccade::tests::GltfBuilder;
using saccade::tests::TemporaryFolder;

struct Outcome {
  std::string refusal;
  Scene scene;
  bool warns(const std::string& part) const {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& w) { return w.find(part) != std::string::npos; });
  }
};

Outcome load(const std::filesystem::path& file) {
  LoadOptions options;
  options.lights = {"point:pos=0,0,5,power=1,1,1"};  // or a panel would be added, with triangles of its own
  try {
    return {"", loadScene(file, options)};
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return {e.what(), {}};
  }
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

Outcome loadBent(const std::function<void(GltfBuilder&)>& bend) {
  TemporaryFolder folder;
  GltfBuilder builder;
  bend(builder);
  return load(builder.write(folder / "a.glb"));
}

Outcome loadText(const std::string& name, const std::string& text) {
  TemporaryFolder folder;
  write(folder / name, text);
  return load(folder / name);
}

#define EXPECT_PART(whole, part) \
  EXPECT_NE((whole).find(part), std::string::npos) << "'" << (whole) << "' lacks '" << (part) << "'"

// ---- glTF

TEST(BadGltf, CutAtEveryByte) {
  TemporaryFolder folder;
  const std::string whole = GltfBuilder().glb();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    write(folder / "cut.glb", whole.substr(0, n));
    EXPECT_NE(load(folder / "cut.glb").refusal, "") << n;
  }
}

/// Gate, parser and conversion for every bit; the whole way, which takes ten times as long, for every ninth.
TEST(BadGltf, EveryBitFlipped) {
  TemporaryFolder folder;
  const auto file = folder / "flipped.glb";
  const std::string whole = GltfBuilder().glb();
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write(file, flipped);
    if (bit % 9 == 0) load(file);
    LoadBudget budget({}, "flipped.glb");
    try {
      loadGltf(file, {}, budget);
    } catch (const Error& e) {
      EXPECT_EQ(std::string(e.what()).rfind("flipped.glb: ", 0), 0u) << e.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, whole.size());
}

TEST(BadGltf, Containers) {
  const std::string whole = GltfBuilder().glb();
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string bent = whole;
    bent.replace(at, bytes.size(), bytes);
    return loadText("a.glb", bent).refusal;
  };
  EXPECT_PART(loadText("a.glb", "").refusal, "empty");
  EXPECT_PART(with(0, "glTG"), "not a glTF file");
  EXPECT_PART(with(4, "\1"), "GLB version 1, must be 2");
  EXPECT_PART(with(8, "\xff\xff\xff\x7f"), "GLB states");
  EXPECT_PART(with(12, "\xff\xff\xff\xff"), "GLB chunk 0 reaches beyond the file");
  EXPECT_PART(with(16, "NOSJ"), "GLB chunk 0 is wrong: there must be one JSON chunk, the first");
  EXPECT_TRUE(loadText("a.glb", whole + "more").warns("bytes behind the end of the GLB"));
}

TEST(BadGltf, FactorsThatAreNoNumbersTakeTheirDefault) {
  TemporaryFolder folder;
  GltfBuilder b;
  b.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0.125;
  b.write(folder / "a.glb");
  std::string glb = b.glb();
  glb.replace(glb.find("0.125"), 5, "  NaN");
  write(folder / "a.glb", glb);
  const Outcome out = load(folder / "a.glb");
  ASSERT_EQ(out.refusal, "");
  EXPECT_TRUE(out.warns("1 material factors out of range"));
  EXPECT_TRUE(out.warns("1 numbers of the JSON are NaN"));
  EXPECT_EQ(out.scene.materials[0].roughness, 1);
}

TEST(BadGltf, CamerasWithAnEmptyDepthRangeStay) {
  const Outcome out = loadBent([](GltfBuilder& b) {
    b.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 5}, {"zfar", 2}}}}};
    b.json["nodes"][0]["camera"] = 0;
  });
  ASSERT_EQ(out.refusal, "");
  EXPECT_TRUE(out.warns("1 cameras whose depth range is empty"));
  EXPECT_FALSE(out.scene.defaultCamera);
}

TEST(BadGltf, IndicesBeyondTheVerticesDropTheirTriangles) {
  const Outcome out = loadBent([](GltfBuilder& b) {
    b.primitive()["indices"] = b.accessor<std::uint16_t>("SCALAR", 5123, {0, 1, 2, 0, 1, 9});
  });
  ASSERT_EQ(out.refusal, "");
  EXPECT_TRUE(out.warns("1 indices name vertices that are not there"));
  EXPECT_EQ(out.scene.triangleCount(), 1u);
}

TEST(BadGltf, SingularMatricesAndZeroQuaternions) {
  const Outcome flat = loadBent([](GltfBuilder& b) {
    b.json["nodes"].push_back({{"mesh", 0}, {"matrix", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
    b.json["scenes"][0]["nodes"] = {0, 1};
  });
  ASSERT_EQ(flat.refusal, "");
  EXPECT_TRUE(flat.warns("1 node matrices are singular"));
  const Outcome turned = loadBent([](GltfBuilder& b) { b.json["nodes"][0]["rotation"] = {0, 0, 0, 0}; });
  ASSERT_EQ(turned.refusal, "");
  EXPECT_TRUE(turned.warns("1 node rotations of length 0"));
}

TEST(BadGltf, ABufferThatClaimsTenTerabytes) {
  EXPECT_PART(
      loadText("a.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":10000000000000}]})").refusal,
      "buffers[0]: 'byteLength' is 10000000000000");
  EXPECT_PART(loadText("a.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":10000000000000,
              "uri":"data:application/octet-stream;base64,AAAA"}]})")
                  .refusal,
              "'byteLength'");
}

TEST(BadGltf, ImagesOfOtherFormatsLeaveTheirTexturesOut) {
  const Outcome out = loadBent([](GltfBuilder& b) {
    const int view = b.view("GIF89a----------", 16);
    b.json["images"] = {{{"bufferView", view}, {"mimeType", "image/gif"}}};
    b.json["textures"] = {{{"source", 0}}};
    b.material()["normalTexture"] = {{"index", 0}};
  });
  ASSERT_EQ(out.refusal, "");
  EXPECT_TRUE(out.warns("1 images are neither PNG nor JPEG"));
  EXPECT_TRUE(out.scene.textures.empty());
}

TEST(BadGltf, DamagedImagesAreRefusedEvenIfNothingShowsThem) {
  EXPECT_PART(loadBent([](GltfBuilder& b) {
                const int view = b.view("\x89PNG\r\n\x1a\n--------", 16);
                b.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
              }).refusal,
              "images[0]: damaged PNG");
}

// ---- OBJ

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(BadObj, IndicesThatAreNotThere) {
  for (const char* face : {"f 1 2 0", "f 1 2 5", "f 1 2 -5", "f 1 2 99999999999",
                           "f 1 2 99999999999999999999999", "f 1 2 x", "f 1 2 1.5", "f 1 2 /3"}) {
    const Outcome out = loadText("a.obj", kSquare + "f 1 2 3\n" + face + "\n");
    EXPECT_EQ(out.refusal, "") << face;
    EXPECT_TRUE(out.warns("1 faces with an index out of range")) << face;
    EXPECT_EQ(out.scene.triangleCount(), 1u) << face;
  }
  const Outcome texture = loadText("a.obj", kSquare + "vt 0 0\nf 1/1/1 2/7/1 3/1/-3\n");
  EXPECT_EQ(texture.refusal, "");
  EXPECT_TRUE(texture.warns("1 texture coordinate indices out of range"));
  EXPECT_TRUE(texture.warns("3 normal indices out of range"));
}

TEST(BadObj, NumbersThatAreNone) {
  for (const char* bad : {"nan", "-inf", "1e999", "0x10", "1,5", "one"}) {
    const Outcome out = loadText("a.obj", kSquare + "v 2 2 " + bad + "\nf 1 2 3\nf 1 2 5\n");
    EXPECT_EQ(out.refusal, "") << bad;
    EXPECT_TRUE(out.warns("1 vertices lack a coordinate")) << bad;
    EXPECT_EQ(out.scene.triangleCount(), 1u) << bad;
  }
  EXPECT_TRUE(loadText("a.obj", kSquare + "v 1\nf 1 2 3\n").warns("1 vertices lack a coordinate"));
  EXPECT_FALSE(loadText("a.obj", "v 0. .0 +0\nv 1e0 0 1e-999\nv 1.0E+0 1 0\nf 1 2 3\n").warns("coordinate"));
}

TEST(BadObj, FacesOfTwoAndOfManyCorners) {
  EXPECT_TRUE(loadText("a.obj", kSquare + "f 1 2 3\nf 1 2\n").warns("1 faces of fewer than three corners"));
  std::string vertices, face = "f";
  constexpr int kCorners = 300;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    vertices += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  const Outcome disk = loadText("a.obj", vertices + face + "\n");
  ASSERT_EQ(disk.refusal, "");
  EXPECT_EQ(disk.scene.triangleCount(), 298u);
  std::string many = "f";
  for (int i = 0; i < 5000; ++i) many += " 1 2 3 4";
  EXPECT_PART(loadText("a.obj", kSquare + many + "\n").refusal,
              "a.obj: line 5: a polygon of more than 4096 corners");
}

TEST(BadObj, EndsOfLines) {
  std::string crlf = kSquare + "f 1 2 3\nf 1 3 4\n", cr = crlf;
  for (std::size_t at = 0; (at = crlf.find('\n', at)) != std::string::npos; at += 2) crlf.insert(at, "\r");
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  EXPECT_EQ(loadText("a.obj", crlf).scene.triangleCount(), 2u);
  EXPECT_EQ(loadText("a.obj", cr).scene.triangleCount(), 2u);
  EXPECT_EQ(loadText("a.obj", (kSquare + "f 1 2 3")).scene.triangleCount(), 1u);
}

TEST(BadObj, ALineOfTenMegabytes) {
  EXPECT_PART(loadText("a.obj", kSquare + "# " + std::string(10 << 20, 'x') + "\nf 1 2 3\n").refusal,
              "a.obj: line 5: longer than 1048576 bytes");
  EXPECT_PART(loadText("a.obj", std::string(10 << 20, 'v')).refusal, "line 1: longer than");
}

TEST(BadObj, CutAtEveryByteAndEveryBitFlipped) {
  TemporaryFolder folder;
  const std::string whole = "vt 0 1\nvn 0 0 1\n" + kSquare + "o a\ns 1\nf 1/1/1 2//1 -2 -1/1\n";
  for (std::size_t n = 0; n < whole.size(); ++n) {
    write(folder / "a.obj", whole.substr(0, n));
    const Outcome out = load(folder / "a.obj");
    EXPECT_TRUE(!out.refusal.empty() || out.scene.triangleCount() > 0) << n;
  }
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write(folder / "a.obj", flipped);
    const Outcome out = load(folder / "a.obj");
    EXPECT_TRUE(!out.refusal.empty() || out.scene.triangleCount() > 0) << bit;
  }
}

TEST(BadObj, MaterialsByTheThousand) {
  TemporaryFolder folder;
  std::string mtl;
  for (int i = 0; i < 200'000; ++i) mtl += "newmtl a\n";
  write(folder / "a.mtl", mtl);
  write(folder / "a.obj", "mtllib a.mtl\n" + kSquare + "f 1 2 3\n");
  LoadOptions options;
  options.limits.memoryBytes = 256u << 20;
  try {
    loadScene(folder / "a.obj", options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_PART(std::string(e.what()), "a.mtl: needs");
  }
}

}  // namespace
}  // namespace saccade::core
