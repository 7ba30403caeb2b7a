// Illumination map files: whole, right, or refused.
#include "core/maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/math/half.h"
#include "core/scene/load.h"
#include "tests/hard_case.h"
#include "tests/unit/core/scene_shapes.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using namespace saccade::tests;

IlluminationMaps sample() {
  IlluminationMaps maps;
  maps.width = 4;
  maps.height = 3;
  maps.layers = 2;
  for (int i = 0; i < 4 * 3 * 2 * 3; ++i) maps.texels.push_back(toHalf(0.25f * static_cast<float>(i)));
  maps.detail.height = 4;
  maps.detail.blocks.assign(4 * 3, 0);
  maps.detail.blocks[5] = MapBlock{1, 1, 1, 1}.packed();
  for (int i = 0; i < 4 * 4 * 2 * 3; ++i) maps.detail.texels.push_back(toHalf(0.5f * static_cast<float>(i)));
  maps.charts.meshes.resize(2);
  maps.charts.places = {Vec4(1, 1, 0, 0), Vec4(4, 4, 0.5f, 0.25f), Vec4(0, 0, 0.1f, 0.2f)};
  maps.charts.meshes[0].sourceVertex = {0, 1, 2, 2};
  maps.charts.meshes[0].uv = {{0, 0}, {1, 0}, {0, 1}, {0.5f, 0.5f}};
  maps.charts.meshes[0].indices = {0, 1, 2, 0, 1, 3};
  maps.charts.meshes[1].perVertex = true;
  maps.quality = "preview";
  maps.photons = 12345678901ull;
  maps.key = 0xABCDEF0123456789ull;
  return maps;
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(Half, Hard22RoundTripsEveryFiniteValue) {
  HardCase changed = HardCase::counting("half floats that a round trip changes", "numbers");
  int wrong = 0;
  for (std::uint32_t h = 0; h < 0x10000; ++h) {
    if ((h & 0x7C00) == 0x7C00) continue;
    wrong += toHalf(fromHalf(static_cast<std::uint16_t>(h))) != h;
  }
  EXPECT_TRUE(changed.within(wrong, 0));
  EXPECT_EQ(fromHalf(toHalf(1.0f + 1.0f / 2048)), 1.0f);  // halfway, to even
}

TEST(Half, Hard22RoundsToTheNearestUpTo65504) {
  // The step there is 32; halfway to the next, 65520, is where infinity begins.
  HardCase off("half floats from 60000 to 65519.99: distance from the value", "half steps");
  for (float x = 60000; x < 65520; x += 0.37f)
    EXPECT_TRUE(off.within(std::fabs(fromHalf(toHalf(x)) - x) / 16, 1)) << x;
  EXPECT_TRUE(off.within(std::fabs(fromHalf(toHalf(std::nextafter(65520.0f, 0.0f))) - 65504) / 16, 0));
  EXPECT_EQ(fromHalf(toHalf(65520)), kInfinity);
}

TEST(Maps, RoundTrip) {
  TemporaryFolder folder;
  const IlluminationMaps maps = sample();
  writeMaps(folder / "a.maps", maps);
  EXPECT_EQ(folder.entries(), 1u);
  const IlluminationMaps back = readMaps(folder / "a.maps", maps.key);
  EXPECT_EQ(back.width, maps.width);
  EXPECT_EQ(back.height, maps.height);
  EXPECT_EQ(back.layers, maps.layers);
  EXPECT_EQ(back.texels, maps.texels);
  EXPECT_EQ(back.detail.height, maps.detail.height);
  EXPECT_EQ(back.detail.blocks, maps.detail.blocks);
  EXPECT_EQ(back.detail.texels, maps.detail.texels);
  for (std::size_t m = 0; m < maps.charts.meshes.size(); ++m)
    EXPECT_EQ(back.charts.meshes[m].perVertex, maps.charts.meshes[m].perVertex);
  EXPECT_EQ(back.quality, maps.quality);
  EXPECT_EQ(back.photons, maps.photons);
  EXPECT_EQ(back.key, maps.key);
  ASSERT_EQ(back.charts.meshes.size(), 2u);
  EXPECT_EQ(back.charts.meshes[0].sourceVertex, maps.charts.meshes[0].sourceVertex);
  EXPECT_EQ(back.charts.meshes[0].uv, maps.charts.meshes[0].uv);
  EXPECT_EQ(back.charts.places, maps.charts.places);
  EXPECT_EQ(back.charts.meshes[0].indices, maps.charts.meshes[0].indices);
  EXPECT_NO_THROW(readMaps(folder / "a.maps", 0));
}

TEST(Maps, EveryTruncationAndFlippedBitsAreRefused) {
  TemporaryFolder folder;
  writeMaps(folder / "whole.maps", sample());
  const std::string whole = bytesOf(folder / "whole.maps");
  for (std::size_t n = 0; n < whole.size(); ++n) {
    write(folder / "cut.maps", whole.substr(0, n));
    EXPECT_THROW(readMaps(folder / "cut.maps", 0), Error) << n;
    if (n % 5 != 0) continue;
    std::string flipped = whole;
    flipped[n] = static_cast<char>(flipped[n] ^ 0x10);
    write(folder / "flipped.maps", flipped);
    EXPECT_THROW(readMaps(folder / "flipped.maps", 0), Error) << n;
  }
  write(folder / "long.maps", whole + "x");
  EXPECT_THROW(readMaps(folder / "long.maps", 0), Error);
}

TEST(Maps, AnotherScenesFileIsRefused) {
  TemporaryFolder folder;
  writeMaps(folder / "a.maps", sample());
  EXPECT_THROW(readMaps(folder / "a.maps", sample().key + 1), Error);
  EXPECT_THROW(readMaps(folder / "missing.maps", 0), Error);
  EXPECT_THROW(readMaps(folder.path(), 0), Error);
}

TEST(Maps, TexelsThatAreNotFiniteAreRefused) {
  TemporaryFolder folder;
  IlluminationMaps maps = sample();
  maps.texels[5] = 0x7E00;
  writeMaps(folder / "nan.maps", maps);
  EXPECT_THROW(readMaps(folder / "nan.maps", 0), Error);
  maps = sample();
  maps.detail.texels.back() = 0xFC00;
  writeMaps(folder / "infinite.maps", maps);
  EXPECT_THROW(readMaps(folder / "infinite.maps", 0), Error);
}

TEST(Maps, DetailThatDoesNotFitIsRefused) {
  TemporaryFolder folder;
  IlluminationMaps maps = sample();
  maps.detail.blocks[5] = MapBlock{2, 1, 1, 1}.packed();
  writeMaps(folder / "a.maps", maps);
  EXPECT_THROW(readMaps(folder / "a.maps", 0), Error);
  maps.detail = {};
  writeMaps(folder / "a.maps", maps);
  EXPECT_TRUE(readMaps(folder / "a.maps", 0).detail.empty());
}

TEST(Maps, AnotherVersionsFileIsRefusedByItsVersion) {
  TemporaryFolder folder;
  writeMaps(folder / "a.maps", sample());
  std::string bytes = bytesOf(folder / "a.maps");
  bytes[8] = 2;  // after the magic
  write(folder / "old.maps", bytes);
  try {
    readMaps(folder / "old.maps", 0);
    ADD_FAILURE() << "was read";
  } catch (const Error& e) {
    const std::string wanted = "has version 2, must be " + std::to_string(kMapsVersion) + "; bake again";
    EXPECT_NE(std::string(e.what()).find(wanted), std::string::npos) << e.what();
  }
}

TEST(Maps, LightBytesAreWhatTheVectorsHold) {
  EXPECT_EQ(sample().lightBytes(), 4 * 3 * 2 * 6u + 4 * 3 * 4u + 4 * 4 * 2 * 6u);
}

TEST(Maps, TexelDecodesAndClamps) {
  const IlluminationMaps maps = sample();
  EXPECT_EQ(maps.texel(1, 2, 0), Vec3(0.25f * 27, 0.25f * 28, 0.25f * 29));
  EXPECT_EQ(maps.texel(0, 0, 1), Vec3(0.25f * 36, 0.25f * 37, 0.25f * 38));
  EXPECT_EQ(maps.texel(-5, 99, 7), maps.texel(0, 2, 1));
}

Scene room() {
  Scene scene;
  scene.materials = {lambert(), lamp()};
  addObject(scene, boxMesh(Vec3(0), Vec3(1)), 0, 0);
  addObject(scene, boxMesh(Vec3(0, 3, 0), Vec3(1, 4, 1)), 1, 1);
  Texture t;
  t.image = ImageRgba8(3, 3);
  scene.textures.push_back(t);
  completeScene(scene, {});
  return scene;
}

SceneCharts cornerCharts(const Scene& scene) {
  SceneCharts out;
  for (const Object& o : scene.objects) {
    MeshCharts c;
    for (std::uint32_t i = 0; i < scene.meshOf(o).indices.size(); ++i) {
      c.sourceVertex.push_back(scene.meshOf(o).indices[i]);
      c.uv.emplace_back(static_cast<float>(i) / 100, 0.5f);
      c.indices.push_back(i);
    }
    out.meshes.push_back(c);
    out.places.emplace_back(1, 1, 0, 0);
  }
  return out;
}

TEST(Maps, ChartsCutTheMeshWithoutChangingTheScene) {
  Scene scene = room();
  const std::uint64_t key = sceneKey(scene);
  const Mesh before = scene.meshes[0];
  applyCharts(scene, cornerCharts(scene));
  const Mesh& after = scene.meshes[0];
  EXPECT_EQ(after.lightmapUv.size(), after.positions.size());
  ASSERT_EQ(after.indices.size(), before.indices.size());
  for (std::size_t i = 0; i < before.indices.size(); ++i) {
    EXPECT_EQ(after.positions[after.indices[i]], before.positions[before.indices[i]]);
    EXPECT_EQ(after.normals[after.indices[i]], before.normals[before.indices[i]]);
  }
  EXPECT_EQ(sceneKey(scene), key);
}

TEST(Maps, ChartsThatDoNotFitAreRefused) {
  Scene scene = room();
  auto charts = cornerCharts(scene);
  charts.meshes[1].sourceVertex[0] = 9999;
  EXPECT_THROW(applyCharts(scene, charts), Error);
  charts.meshes.pop_back();
  EXPECT_THROW(applyCharts(scene, charts), Error);
  charts = cornerCharts(scene);
  charts.places.pop_back();
  EXPECT_THROW(applyCharts(scene, charts), Error);
}

TEST(SceneKey, DependsOnAllThatLightDoes) {
  const std::uint64_t key = sceneKey(room());
  EXPECT_EQ(sceneKey(room()), key);
  const auto differs = [&](auto&& change) {
    Scene scene = room();
    change(scene);
    EXPECT_NE(sceneKey(scene), key);
  };
  differs([](Scene& s) { s.meshes[0].positions[3].x += 1e-6f; });
  differs([](Scene& s) { s.meshes[0].normals[3] = -s.meshes[0].normals[3]; });
  differs([](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); });
  differs([](Scene& s) { s.objects[0].material = 1; });
  differs([](Scene& s) { s.objects[0].meshToWorld[3].x = 1; });
  differs([](Scene& s) { s.objects[1].mesh = 0; });
  differs([](Scene& s) { s.materials[0].baseColor.y = 0.5f; });
  differs([](Scene& s) { s.materials[0].doubleSided = true; });
  differs([](Scene& s) { s.materials[1].emission *= 2; });
  differs([](Scene& s) { s.textures[0].image.at(2, 2).b = 1; });
  differs([](Scene& s) { s.textures[0].srgb = true; });
  differs([](Scene& s) { s.lights.emplace_back(); });
  differs([](Scene& s) { s.materials[0].clearcoat = 0.5f; });
  differs([](Scene& s) { s.materials[0].ward.emplace(); });
  differs([](Scene& s) { s.materials[0].baseColorTexture.scale.x = 2; });
  Scene moved = room();
  moved.cameras[0].eye.x += 1;
  moved.path = "elsewhere";
  EXPECT_EQ(sceneKey(moved), key);
}

TEST(MapsPath, LiesInTheCacheAndTellsSettingsApart) {
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before ? before : "";
  ::setenv("XDG_CACHE_HOME", "/some/cache", 1);
  const auto a = defaultMapsPath(1, "preview"), b = defaultMapsPath(1, "medium"),
             c = defaultMapsPath(2, "preview");
  EXPECT_EQ(a.parent_path(), "/some/cache/saccade");
  EXPECT_EQ(a.extension(), ".maps");
  EXPECT_TRUE(a != b && a != c && b != c);
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_NE(defaultMapsPath(1, "preview").string().find(".cache/saccade"), std::string::npos);
  if (before) ::setenv("XDG_CACHE_HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace saccade::core
