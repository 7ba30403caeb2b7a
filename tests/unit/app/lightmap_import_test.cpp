// bake --import: files matched to nodes, conventions, and the picture that comes out.
#include "app/session/lightmap_import.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/image_io.h"
#include "core/scene/load.h"
#include "core/scene/specular_albedo.h"
#include "tests/unit/app/fixtures.h"
#include "tests/unit/core/gltf_builder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using core::Vec3;

/// An empty folder of this test's own.
fs::path freshFolder(const std::string& name) {
  const fs::path folder = tests::temporaryFolder() / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

/// "floor" (a unit square at y = 0, its second UV set turned by a quarter) and "shelf" (no second UV set).
fs::path twoSquares(const fs::path& folder) {
  tests::GltfBuilder b;
  const int index = b.accessor<std::uint16_t>("SCALAR", 5123, {0, 1, 2, 0, 2, 3});
  const int floor = b.floats("VEC3", {0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0});
  const int uv = b.floats("VEC2", {0, 0, 1, 0, 1, 1, 0, 1});  // u along z, v along x
  const int shelf = b.floats("VEC3", {3, 0, 0, 3, 0, 1, 4, 0, 1, 4, 0, 0});
  b.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}},
       {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}}};
  b.json["extensionsUsed"] = {"KHR_materials_specular"};
  const auto mesh = [&](nlohmann::json attributes) {
    return nlohmann::json{
        {"primitives", {{{"attributes", attributes}, {"indices", index}, {"material", 0}}}}};
  };
  b.json["meshes"] = {mesh({{"POSITION", floor}, {"TEXCOORD_0", uv}, {"TEXCOORD_1", uv}}),
                      mesh({{"POSITION", shelf}})};
  b.json["nodes"] = {{{"mesh", 0}, {"name", "floor"}}, {{"mesh", 1}, {"name", "shelf"}}};
  b.json["scenes"] = {{{"nodes", {0, 1}}}};
  return b.write(folder / "squares.glb");
}

/// Left half code 64, right half code 200 (u grows to the right).
core::ImageRgba8 halves() {
  core::ImageRgba8 image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t code = x < 32 ? 64 : 200;
      image.at(x, y) = {code, code, code, 255};
    }
  return image;
}

std::string errorOf(const fs::path& folder, const core::Scene& scene, float scale = 1) {
  app::LightmapReport report;
  try {
    app::readLightmaps(folder, scene, scale, {}, report);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST(LightmapImport, FilesAreMatchedToNodesAndTheRestIsReported) {
  const fs::path folder = freshFolder("import-match");
  const core::Scene scene = core::loadScene(twoSquares(folder), {});
  core::writePng(folder / "floor.lightmap.png", halves());
  core::writePng(folder / "shelf.png", halves());
  core::writePng(folder / "stranger.png", halves());
  core::writeExr(folder / "stranger.exr", core::ImageRgb(1, 1));  // two for no node: no error
  app::LightmapReport report;
  const raytrace::ImportedLight light = app::readLightmaps(folder, scene, 2, {}, report);
  ASSERT_EQ(light.images.size(), 1u);
  EXPECT_EQ(report.taken, std::vector<std::string>{"floor.lightmap.png (64x64): node 'floor', 1 object"});
  EXPECT_EQ(report.baked, std::vector<std::string>{"shelf"});
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[0].find("'shelf' has parts without a second UV set"), std::string::npos);
  EXPECT_NE(report.warnings[1].find("matches no node"), std::string::npos);
  // pi * decoded value * scale
  EXPECT_NEAR(light.images[0].at(0, 0).x, core::kPi * core::decodeSrgb(64 / 255.0f) * 2, 1e-5f);
  for (std::size_t o = 0; o < scene.objects.size(); ++o)
    EXPECT_EQ(light.imageOfObject[o], scene.objects[o].name == "floor" ? 0 : -1);
}

TEST(LightmapImport, FloatImagesAreLinearAndBadValuesBecomeNone) {
  const fs::path folder = freshFolder("import-exr");
  const core::Scene scene = core::loadScene(twoSquares(folder), {});
  core::ImageRgb image(2, 1, Vec3(0.25f, 3, 40));
  image.at(1, 0) = Vec3(-1, NAN, INFINITY);
  core::writeExr(folder / "floor.exr", image);
  app::LightmapReport report;
  const raytrace::ImportedLight light = app::readLightmaps(folder, scene, 1, {}, report);
  EXPECT_LT(glm::length(light.images[0].at(0, 0) - core::kPi * Vec3(0.25f, 3, 40)), 1e-4f);
  EXPECT_EQ(light.images[0].at(1, 0), Vec3(0));
}

TEST(LightmapImport, RadiancePicturesAreLinear) {
  const fs::path folder = freshFolder("import-hdr");
  const core::Scene scene = core::loadScene(twoSquares(folder), {});
  std::ofstream(folder / "floor.lightmap.hdr", std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x20\x83";  // mantissa / 256 * 2^3
  app::LightmapReport report;
  const raytrace::ImportedLight light = app::readLightmaps(folder, scene, 1, {}, report);
  const Vec3 value = light.images.at(0).at(0, 0) / core::kPi;
  EXPECT_NEAR(value.x, 4, 0.05f);
  EXPECT_NEAR(value.y, 2, 0.05f);
  EXPECT_NEAR(value.z, 1, 0.05f);
}

TEST(LightmapImport, ErrorsSayWhatToDo) {
  const fs::path folder = freshFolder("import-errors");
  const core::Scene scene = core::loadScene(twoSquares(folder), {});
  EXPECT_NE(errorOf(folder / "none", scene).find("takes a folder"), std::string::npos);
  EXPECT_NE(errorOf(folder, scene).find("name them NODE.lightmap.png"), std::string::npos);
  core::writePng(folder / "floor.png", halves());
  EXPECT_NE(errorOf(folder, scene, 0).find("--import-scale"), std::string::npos);
  core::writeExr(folder / "floor.exr", core::ImageRgb(1, 1));
  EXPECT_NE(errorOf(folder, scene).find("keep one of them"), std::string::npos);
  fs::remove(folder / "floor.exr");
  app::LightmapReport report;
  EXPECT_THROW(app::readLightmaps(folder, scene, 1, {.memoryBytes = 10000}, report), core::Error);
  std::ofstream(folder / "floor.png") << "no image";
  EXPECT_NE(errorOf(folder, scene), "");
}

TEST(LightmapImport, ThePictureShowsTheImportedLight) {
  const fs::path folder = freshFolder("import-picture");
  app::SceneOptions options;
  options.path = twoSquares(folder).string();
  options.quality = "preview";
  options.photons = 1000;
  core::writePng(folder / "floor.lightmap.png", halves());
  app::BakeRequest bake;
  bake.file = folder / "squares.maps";
  bake.always = true;
  bake.importFolder = folder;
  app::openWorkspace(options, bake, {});
  // Later commands find the light in the file, without the folder.
  bake.always = false;
  bake.importFolder.clear();
  const auto workspace = app::openWorkspace(options, bake, {});
  app::Headless gl(tests::runOn("osmesa"), *workspace);
  core::Camera camera;
  camera.eye = Vec3(0.5f, 1, 0.5f);
  camera.at = Vec3(0.5f, 0, 0.5f);
  camera.up = Vec3(0, 0, -1);
  camera.fovYDegrees = 50;
  const core::FramePtr frame =
      gl.renderer->render(core::View(camera, 64, 64, workspace->scene.bounds), 1, 10);
  // u grows along z, which points down in this picture: dark above, bright below.
  const auto radiance = [&](int x, int y) {
    return frame->baseAndId[static_cast<std::size_t>(y) * 64 + x].x;
  };
  EXPECT_NEAR(radiance(20, 16), 0.5f * core::decodeSrgb(64 / 255.0f), 0.002f);
  EXPECT_NEAR(radiance(44, 48), 0.5f * core::decodeSrgb(200 / 255.0f), 0.004f);
}

TEST(LightmapImport, BabylonsCornellBox) {
  SACCADE_SHARED_FILE(file, "scenes/lightmapped/cornellBox.glb");
  const core::Scene scene = core::loadScene(file, {});
  app::LightmapReport report;
  const raytrace::ImportedLight light = app::readLightmaps(file.parent_path(), scene, 1, {}, report);
  EXPECT_EQ(light.images.size(), 2u);
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(report.baked, (std::vector<std::string>{"lamp.000", "suzanne.000"}));
}

}  // namespace
}  // namespace saccade
