// A second UV set that is an atlas stays the layout of its mesh's charts, and is lit like charts of our own;
// what misses being one, does so for its reason.
#include "raytrace/bake/own_atlas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bake_scenes.h"
#include "core/scene/load.h"
#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/texel_map.h"
#include "tests/shared_folder.h"

namespace saccade::raytrace {
namespace {

using core::Vec2;
using core::Vec3;

constexpr double kTexels = 1 << 16;
constexpr int kQuads = 4;

/// kQuads^2 quads over corner + s u + t v, with uv1 in the square of side `side` from `place`.
void addPatch(core::Mesh& mesh, Vec3 corner, Vec3 u, Vec3 v, Vec2 place, float side) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int y = 0; y <= kQuads; ++y) {
    for (int x = 0; x <= kQuads; ++x) {
      const Vec2 st = Vec2(static_cast<float>(x), static_cast<float>(y)) / static_cast<float>(kQuads);
      mesh.positions.push_back(corner + st.x * u + st.y * v);
      mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
      mesh.uv1.push_back(place + side * st);
    }
  }
  const auto at = [&](int x, int y) { return first + static_cast<std::uint32_t>(y * (kQuads + 1) + x); };
  for (int y = 0; y < kQuads; ++y) {
    for (int x = 0; x < kQuads; ++x) {
      for (const std::uint32_t i :
           {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)}) {
        mesh.indices.push_back(i);
      }
    }
  }
}

/// A floor and a wall of 2 x 2 m, side by side in uv1 with a gutter of 0.06 (0.27 m) between.
core::Mesh corner() {
  core::Mesh mesh;
  addPatch(mesh, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2), Vec2(0.02f), 0.45f);
  addPatch(mesh, Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec2(0.53f, 0.02f), 0.45f);
  return mesh;
}

/// The corner (object 0) with a lamp before the wall.
core::Scene cornerScene(core::Mesh mesh) {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  b.scene.meshes[0] = std::move(mesh);
  b.scene.objects[0].bounds = {};
  for (const Vec3& p : b.scene.meshes[0].positions) b.scene.objects[0].bounds.add(p);
  b.scene.bounds.add(b.scene.objects[0].bounds);
  b.disk(SceneBuilder::matte(0, Vec3(10)), Vec3(0.3f, 1.5f, 0.2f), 0.3f, 16);
  return b.scene;
}

core::Plan planOf(int size) {
  core::Plan plan;
  plan.lightmapSize = size;
  return plan;
}

std::size_t countOf(const ChartAtlas& atlas, AtlasFault fault) {
  return atlas.ownAtlases[static_cast<std::size_t>(fault)];
}

/// uv = scale uv1 + offset, in either direction.
void expectAffine(const core::Mesh& mesh, const std::vector<Vec2>& uv) {
  ASSERT_EQ(uv.size(), mesh.uv1.size());
  const std::size_t last = kQuads * (kQuads + 1) + kQuads;  // the first patch's other corner
  const Vec2 scale = (uv[last] - uv[0]) / (mesh.uv1[last] - mesh.uv1[0]);
  EXPECT_GT(scale.x, 0);
  EXPECT_GT(scale.y, 0);
  for (std::size_t v = 0; v < uv.size(); ++v) {
    const Vec2 expected = uv[0] + scale * (mesh.uv1[v] - mesh.uv1[0]);
    EXPECT_NEAR(uv[v].x, expected.x, 2e-6) << v;
    EXPECT_NEAR(uv[v].y, expected.y, 2e-6) << v;
  }
}

TEST(OwnAtlas, ThatIsProperIsKept) {
  const core::Mesh mesh = corner();
  const core::Scene scene = cornerScene(mesh);
  const ChartAtlas atlas = makeCharts(scene, planOf(256), 256);
  EXPECT_EQ(countOf(atlas, AtlasFault::none), 1u);
  const core::MeshCharts& charts = atlas.charts.meshes[0];
  EXPECT_EQ(charts.indices, mesh.indices);
  for (std::size_t v = 0; v < charts.sourceVertex.size(); ++v) EXPECT_EQ(charts.sourceVertex[v], v);
  expectAffine(mesh, charts.uv);
  const Vec2 side = (charts.uv[kQuads * (kQuads + 1) + kQuads] - charts.uv[0]) * 256.0f;
  EXPECT_NEAR(side.x, 2 / atlas.texelMetres, 0.6f);
  EXPECT_NEAR(side.y, 2 / atlas.texelMetres, 0.6f);
}

TEST(OwnAtlas, KeepsAnotherScaleAlongEitherAxis) {
  core::Mesh wall;  // 4 x 1 m over a square
  addPatch(wall, Vec3(0), Vec3(4, 0, 0), Vec3(0, 1, 0), Vec2(0), 1);
  const OwnAtlas atlas = examineAtlas(wall, kTexels);
  EXPECT_EQ(atlas.fault, AtlasFault::none);
  EXPECT_NEAR(atlas.metres.x, 4, 1e-6);
  EXPECT_NEAR(atlas.metres.y, 1, 1e-6);
  EXPECT_EQ(atlas.coarsestTexel, core::kInfinity);
}

TEST(OwnAtlas, KeepsItsGuttersHoweverCoarseTheWish) {
  core::Scene scene = cornerScene(corner());
  ChartLayout layout(scene, kTexels);
  ASSERT_TRUE(layout.pack(std::vector<double>(layout.items().size(), 100.0), 256));
  core::applyCharts(scene, layout.cut(256));
  const TexelMap texels(scene, 256);
  ASSERT_EQ(texels.charts().size(), 2u);  // the lamp is black
  EXPECT_GE(texels.charts()[1].x0 - texels.charts()[0].x1, 2);
  EXPECT_LT(texels.charts()[1].x1 - texels.charts()[0].x0, 100);
}

TEST(OwnAtlas, GuttersAreNeverTakenForWiderThanTheyAre) {
  for (const float gutter : {0.03f, 0.1f, 0.37f}) {
    core::Mesh mesh;
    const float side = (1 - gutter) / 2;
    addPatch(mesh, Vec3(0), Vec3(1, 0, 0), Vec3(0, 0, -1), Vec2(0), side);
    addPatch(mesh, Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, -1), Vec2(side + gutter, 0), side);
    const OwnAtlas atlas = examineAtlas(mesh, kTexels);
    ASSERT_EQ(atlas.fault, AtlasFault::none);
    const double width = kGutterTexels * atlas.coarsestTexel, truth = gutter / side;
    const double cell = std::sqrt((2 + truth) / (4 * kTexels));
    EXPECT_LE(width, truth + 1e-6);
    EXPECT_GE(width, truth - 2.01 * cell);
  }
}

TEST(OwnAtlas, IsLitLikeChartsOfOurOwn) {
  BakeOptions options;
  options.quality = "medium";
  options.photons = 1 << 18;
  core::Mesh without = corner();
  without.uv1.clear();
  const Baked kept(cornerScene(corner()), 128, options), cut(cornerScene(without), 128, options);
  ASSERT_EQ(kept.scene().meshes[0].positions.size(), without.positions.size());
  double difference = 0, sum = 0;
  const int n = 40;
  for (int i = 0; i < n * n; ++i) {
    // Up to the borders: look-ups there reach into the gutters.
    const float s = 1.998f * (static_cast<float>(i % n) / (n - 1) - 0.5f),
                t = 1.998f * static_cast<float>(i / n) / (n - 1) + 0.001f;
    for (const Vec3& p : {Vec3(s, 0, 1 - t), Vec3(s, t, -1)}) {
      const double a = kept.irradiance(0, p).x, b = cut.irradiance(0, p).x;
      difference += (a - b) * (a - b);
      sum += b;
    }
  }
  const double count = 2 * n * n;
  EXPECT_LT(std::sqrt(difference / count), 0.02 * sum / count);
}

TEST(OwnAtlas, OfAnInstancedMeshStandsInEachBlock) {
  core::Scene scene = cornerScene(corner());
  scene.meshes[0].instanced = true;
  core::Object twice = scene.objects[0];
  twice.meshToWorld = core::Mat4(core::Vec4(2, 0, 0, 0), core::Vec4(0, 2, 0, 0), core::Vec4(0, 0, 2, 0),
                                 core::Vec4(9, 0, 0, 1));
  scene.objects.push_back(twice);
  const core::Mesh mesh = scene.meshes[0];
  const ChartAtlas atlas = makeCharts(scene, planOf(256), 256);
  EXPECT_EQ(countOf(atlas, AtlasFault::none), 1u);
  expectAffine(mesh, atlas.charts.meshes[0].uv);
  EXPECT_EQ(atlas.charts.places[2].x, 2 * atlas.charts.places[0].x);
  core::applyCharts(scene, atlas.charts);
  const TexelMap texels(scene, atlas.size);
  double area[3] = {0, 0, 0};
  for (std::size_t texel = 0; texel < texels.texelCount(); ++texel) {
    for (const TexelFragment& f : texels.fragments(texel)) {
      ASSERT_EQ(f.object, texels.fragments(texel).front().object);
      area[f.object] += f.area;
    }
  }
  EXPECT_NEAR(area[0], 8, 0.01);
  EXPECT_NEAR(area[2], 32, 0.04);
}

/// The fault, and that charts of our own stand in.
void expectRefused(const core::Mesh& mesh, AtlasFault fault) {
  EXPECT_EQ(examineAtlas(mesh, kTexels).fault, fault) << describe(fault);
  const ChartAtlas atlas = makeCharts(cornerScene(mesh), planOf(256), 256);
  EXPECT_EQ(countOf(atlas, fault), 1u) << describe(fault);
  EXPECT_EQ(countOf(atlas, AtlasFault::none), 0u);
  EXPECT_EQ(atlas.chartCount, 2u + 1u);  // floor, wall and the shared texel
}

TEST(OwnAtlas, MissingOrUnfit) {
  core::Mesh mesh = corner();
  mesh.uv1.clear();
  expectRefused(mesh, AtlasFault::missing);
  mesh = corner();
  mesh.uv1.pop_back();
  expectRefused(mesh, AtlasFault::missing);
}

TEST(OwnAtlas, NotANumber) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    core::Mesh mesh = corner();
    mesh.uv1[7].y = bad;
    expectRefused(mesh, AtlasFault::notFinite);
  }
}

TEST(OwnAtlas, OutsideByMoreThanATenThousandth) {
  core::Mesh mesh = corner();
  for (Vec2& uv : mesh.uv1) uv.y -= 0.02f + 5e-5f;
  EXPECT_EQ(examineAtlas(mesh, kTexels).fault, AtlasFault::none);
  for (Vec2& uv : mesh.uv1) uv.y -= 1e-4f;
  expectRefused(mesh, AtlasFault::outside);
}

TEST(OwnAtlas, ATriangleWithoutArea) {
  core::Mesh mesh = corner();
  mesh.uv1[0] = mesh.uv1[1];  // a corner: one triangle falls flat
  expectRefused(mesh, AtlasFault::flat);
}

TEST(OwnAtlas, ATriangleWithoutAreaInSpaceMayHaveNone) {
  core::Mesh mesh = corner();
  for (int i = 0; i < 3; ++i) mesh.indices.push_back(5);
  EXPECT_EQ(examineAtlas(mesh, kTexels).fault, AtlasFault::none);
}

TEST(OwnAtlas, DensityFourTimesTheMean) {
  for (const float side : {0.25f, 0.15f}) {  // of 0.45: the wall's density is 0.47 and 0.2 of the mean
    core::Mesh mesh;
    addPatch(mesh, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2), Vec2(0.02f), 0.45f);
    addPatch(mesh, Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec2(0.53f, 0.02f), side);
    if (side > 0.2f)
      EXPECT_EQ(examineAtlas(mesh, kTexels).fault, AtlasFault::none);
    else
      expectRefused(mesh, AtlasFault::stretched);
  }
}

TEST(OwnAtlas, OneWayNineTimesTheOther) {
  core::Mesh mesh = corner();
  for (std::size_t v = 0; v < mesh.uv1.size(); ++v) {
    const Vec2 uv = mesh.uv1[v];
    // The floor three times as wide as high, the wall three times as high as wide.
    mesh.uv1[v] = v < mesh.uv1.size() / 2 ? Vec2(uv.x, uv.y / 9) : Vec2(0.53f + (uv.x - 0.53f) / 9, uv.y);
  }
  expectRefused(mesh, AtlasFault::stretched);
}

TEST(OwnAtlas, MostlyEmpty) {
  core::Mesh mesh;
  addPatch(mesh, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2), Vec2(0), 0.25f);
  addPatch(mesh, Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec2(0.75f), 0.25f);
  expectRefused(mesh, AtlasFault::wasteful);
}

TEST(OwnAtlas, FloorAndWallInTheSamePlaceOrHalfOverEachOther) {
  for (const float shift : {0.0f, 0.2f, 0.43f}) {
    core::Mesh mesh;
    addPatch(mesh, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2), Vec2(0.02f), 0.45f);
    addPatch(mesh, Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec2(0.02f + shift, 0.02f), 0.45f);
    expectRefused(mesh, AtlasFault::overlapping);
  }
}

TEST(OwnAtlas, AChartThatFoldsOverItself) {
  core::Mesh mesh = corner();
  for (Vec2& uv : mesh.uv1) {
    if (uv.x < 0.5f) uv.x = std::abs(uv.x - 0.22f) + 0.1f;
  }
  EXPECT_EQ(examineAtlas(mesh, kTexels).fault, AtlasFault::overlapping);
}

TEST(OwnAtlas, ChartsThatTouchOrHaveNarrowGutters) {
  for (const float gutter : {0.0f, 0.003f}) {
    core::Mesh mesh;
    addPatch(mesh, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2), Vec2(0), 0.45f);
    addPatch(mesh, Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec2(0.45f + gutter, 0), 0.45f);
    expectRefused(mesh, AtlasFault::crowded);
  }
}

TEST(OwnAtlas, GuttersAreWideEnoughWithMoreTexels) {
  EXPECT_EQ(examineAtlas(corner(), 1 << 12).fault, AtlasFault::none);
  EXPECT_EQ(examineAtlas(corner(), 1 << 10).fault, AtlasFault::crowded);
}

TEST(OwnAtlas, AChartAroundASharpEdge) {
  core::Mesh mesh;
  addPatch(mesh, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2), Vec2(0), 0.5f);
  addPatch(mesh, Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec2(0, 0.5f), 0.5f);
  expectRefused(mesh, AtlasFault::creased);
}

TEST(OwnAtlas, OfBabylonsCornellBox) {
  SACCADE_SHARED_FILE(file, "scenes/lightmapped/cornellBox.glb");
  const core::Scene scene = core::loadScene(file, {});
  const auto faultOf = [&](const std::string& name) {
    for (const core::Object& object : scene.objects) {
      if (object.name == name) return examineAtlas(scene.meshOf(object), 1 << 17).fault;
    }
    return AtlasFault::missing;
  };
  for (const char* part : {"/0", "/1", "/2", "/3"})
    EXPECT_EQ(faultOf(std::string("cornellBox.000") + part), AtlasFault::none) << part;
  EXPECT_EQ(faultOf("bloc.000"), AtlasFault::creased);  // a bevelled box: its bevels hang on its sides
  EXPECT_EQ(faultOf("suzanne.000"), AtlasFault::stretched);
  EXPECT_EQ(faultOf("lamp.000"), AtlasFault::missing);
}

}  // namespace
}  // namespace saccade::raytrace
