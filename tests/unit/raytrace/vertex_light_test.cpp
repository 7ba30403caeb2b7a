// Light kept by vertex: look-ups, what texels hold, and bakes against known light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/math/half.h"
#include "core/math/random.h"
#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/vertex_rings.h"
#include "raytrace/bake/vertex_texels.h"
#include "raytrace/surface_points.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;

constexpr int kAtlas = 128;

/// All meshes by vertex, blocks below one another.
core::SceneCharts byVertex(const core::Scene& scene) {
  core::SceneCharts out;
  int top = 1;
  for (const core::Mesh& mesh : scene.meshes) {
    const VertexTexels texels = vertexTexels(mesh);
    core::MeshCharts charts;
    charts.perVertex = true;
    charts.indices = mesh.indices;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      charts.sourceVertex.push_back(v);
      const int n = static_cast<int>(texels.numberOf[v]);
      charts.uv.push_back((core::Vec2(1 + n % texels.width(), top + n / texels.width()) + 0.5f) /
                          static_cast<float>(kAtlas));
    }
    top += texels.height() + 2;
    EXPECT_LT(std::max(top, texels.width() + 2), kAtlas);
    out.meshes.push_back(std::move(charts));
  }
  out.places.assign(scene.objects.size(), core::Vec4(1, 1, 0, 0));
  return out;
}

constexpr float kPole = 1e-3f;  // no closer, for want of a normal

/// A sphere of n x 2 n quads, with pinholes at the poles.
int addSphere(Builder& b, const core::Material& material, float radius, int n, bool inside) {
  return b.patch(material, 2 * n, n, [=](float s, float t) {
    const float phi = 2 * core::kPi * s, theta = core::kPi * std::clamp(t, kPole, 1 - kPole);
    return radius * Vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                         (inside ? -1.0f : 1.0f) * std::sin(theta) * std::sin(phi));
  });
}

double areaOf(const core::Mesh& mesh) {
  double twice = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]];
    twice += glm::length(glm::cross(glm::dvec3(mesh.positions[mesh.indices[i + 1]]) - a,
                                    glm::dvec3(mesh.positions[mesh.indices[i + 2]]) - a));
  }
  return twice / 2;
}

struct Bake {
  explicit Bake(core::Scene from, const BakeOptions& options) : scene(std::move(from)) {
    core::SceneCharts charts = byVertex(scene);
    core::applyCharts(scene, charts);
    world = std::make_unique<World>(scene, core::Plan());
    maps = bakeMaps(*world, std::move(charts), kAtlas, options, {});
    world->setMaps(&maps);
  }
  core::Scene scene;
  std::unique_ptr<World> world;
  core::IlluminationMaps maps;
};

BakeOptions optionsOf(const std::string& quality, int threads = 2) {
  BakeOptions o;
  o.quality = quality;
  o.threads = threads;
  return o;
}

/// A room with a lamp, a block and a sphere that mirrors it.
core::Scene room() {
  Builder b;
  for (int wall = 0; wall < 2; ++wall) {
    b.patch(Builder::matte(0.6f), 12, 12, [=](float s, float t) {
      return wall == 0 ? Vec3(2 * s - 1, 0, 1 - 2 * t) : Vec3(-1, 2 * s, 2 * t - 1);
    });
  }
  addSphere(b, Builder::matte(0.5f), 0.4f, 16, false);
  b.patch(Builder::matte(0, Vec3(10)), 2, 2, [](float s, float t) { return Vec3(0.4f * s, 1.9f, 0.4f * t); });
  return std::move(b.scene);
}

TEST(VertexTexels, VerticesAlikeShareATexelAndCreasesDoNot) {
  core::Mesh mesh;
  const Vec3 up(0, 1, 0), aside(1, 0, 0);
  mesh.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(0), Vec3(0), Vec3(0, 0, 1)};
  mesh.normals = {up, up, up, aside, up};
  const VertexTexels texels = vertexTexels(mesh);
  EXPECT_EQ(texels.numberOf, (std::vector<std::uint32_t>{0, 1, 0, 2, 3}));
  EXPECT_EQ(texels.count, 4u);
  EXPECT_GE(texels.width() * texels.height(), 4);
}

TEST(VertexLight, LookUpsAreLinearOnEachTriangle) {
  Builder b;
  addSphere(b, Builder::matte(0.5f), 1, 8, false);
  core::Scene scene = std::move(b.scene);
  core::SceneCharts charts = byVertex(scene);
  core::applyCharts(scene, charts);
  core::IlluminationMaps maps;
  maps.width = maps.height = kAtlas;
  maps.layers = 1;
  for (std::size_t i = 0; i < std::size_t{3} * kAtlas * kAtlas; ++i)
    maps.texels.push_back(core::toHalf(static_cast<float>(i * 2654435761u % 1021)));
  World world(scene, {});
  world.setMaps(&maps);
  const core::Mesh& mesh = scene.meshes[0];
  const auto at = [&](std::uint32_t v) {
    const core::Vec2 p = mesh.lightmapUv[v] * static_cast<float>(kAtlas);
    return maps.texel(static_cast<int>(p.x), static_cast<int>(p.y), 0);
  };
  for (std::uint32_t i = 0; i < 2000; ++i) {
    core::PixelSampler random(1, 2, i, 3);
    const auto t = static_cast<std::uint32_t>(random.next1D() * static_cast<float>(mesh.triangleCount()));
    const core::Vec2 p = random.next2D();
    const core::Vec2 bary = p.x + p.y > 1 ? 1.0f - p : p;
    const std::uint32_t* corner = &mesh.indices[std::size_t{3} * t];
    const Vec3 expected =
        at(corner[0]) * (1 - bary.x - bary.y) + at(corner[1]) * bary.x + at(corner[2]) * bary.y;
    const Vec3 found = mapIrradiance(world, surfaceOn(world, 0, t, bary.x, bary.y, true));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-3f) << i;
  }
}

TEST(VertexLight, TexelsHoldThirdsOfTrianglesThatSumToTheSurface) {
  core::Scene scene = room();
  core::applyCharts(scene, byVertex(scene));
  const TexelMap texels(scene, kAtlas);
  std::vector<double> sums(scene.objects.size(), 0);
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    double sum = 0;
    for (const TexelFragment& f : texels.fragments(t)) sum += f.area;
    EXPECT_NEAR(texels.area(t), sum, 1e-6 * sum);
    if (!texels.fragments(t).empty()) sums[texels.fragments(t).front().object] += sum;
  }
  for (std::size_t o = 0; o < sums.size(); ++o) {
    if (!showsIrradiance(scene.materials[static_cast<std::size_t>(scene.objects[o].material)])) continue;
    EXPECT_NEAR(sums[o], areaOf(scene.meshes[o]), 1e-6 * sums[o]) << o;
  }
}

TEST(VertexLight, PointsOfATexelAreNearestToItsVertexAndEven) {
  Builder b;
  b.patch(Builder::matte(0.5f), 3, 3, [](float s, float t) { return Vec3(s, 0.5f * t, 0); });
  core::Scene scene = std::move(b.scene);
  core::applyCharts(scene, byVertex(scene));
  const World world(scene, {});
  const TexelMap texels(scene, kAtlas);
  constexpr int kPoints = 4096;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.fragments(t).empty()) continue;
    glm::dvec3 mean(0), exact(0);
    for (const TexelFragment& f : texels.fragments(t)) {
      const Vec3* p = world.shape(f.triangle).position;
      std::size_t k = 0;
      while (texels.vertexTexel(0, std::size_t{3} * f.triangle + k) != t) ++k;
      // Of the two triangles (vertex, middle of a side, centroid): 22/36 of the vertex, 7/36 of the others.
      exact += double{f.area} / texels.area(t) *
               (glm::dvec3(p[k]) * (22.0 / 36) + glm::dvec3(p[(k + 1) % 3] + p[(k + 2) % 3]) * (7.0 / 36));
    }
    for (int i = 0; i < kPoints; ++i) {
      core::PixelSampler random(5, static_cast<std::uint32_t>(t), static_cast<std::uint64_t>(i), 1);
      const core::Vec2 u = random.next2D();
      const MeshPoint p = texels.pointOn(t, random.next1D(), u.x, u.y);
      EXPECT_EQ(texels.texelAt(world.lightmapUv(0, p.triangle, p.b1, p.b2)), t);
      mean += glm::dvec3(surfaceOn(world, 0, p.triangle, p.b1, p.b2, true).position) / double{kPoints};
    }
    EXPECT_LT(glm::length(mean - exact), 0.006) << t;  // spread 0.1 over the root of 4096, four times
  }
}

TEST(VertexLight, NeighboursAreThoseThatEdgesJoin) {
  Builder b;
  b.patch(Builder::matte(0.5f), 2, 2, [](float s, float t) { return Vec3(s, t, 0); });
  core::Scene scene = std::move(b.scene);
  core::applyCharts(scene, byVertex(scene));
  const TexelMap texels(scene, kAtlas);
  const VertexGraph graph(texels);
  ASSERT_EQ(graph.vertices().size(), 9u);
  std::multiset<std::size_t> counts;
  for (const std::uint32_t v : graph.vertices()) {
    counts.insert(graph.neighbours(v).size());
    for (const std::uint32_t n : graph.neighbours(v)) {
      const auto back = graph.neighbours(n);
      EXPECT_NE(std::find(back.begin(), back.end(), v), back.end());
    }
  }
  EXPECT_EQ(counts, (std::multiset<std::size_t>{2, 2, 3, 3, 4, 4, 4, 4, 6}));
}

TEST(VertexLight, TheSameBitsForAnyNumberOfThreads) {
  const Bake one(room(), optionsOf("medium", 0));
  for (const int threads : {1, 3})
    EXPECT_EQ(Bake(room(), optionsOf("medium", threads)).maps.texels, one.maps.texels);
}

/// A floor and a patch of n x n quads over [-1, 1]^2, `bump` times 1 high.
core::Scene floorAndPatch(int n, float bump) {
  Builder b;
  b.quad(Builder::matte(0.5f), Vec3(-5, -1, 5), Vec3(10, 0, 0), Vec3(0, 0, -10));
  b.patch(Builder::matte(0.5f), n, n, [=](float s, float t) {
    const float x = 2 * s - 1, z = 1 - 2 * t;
    return Vec3(x, bump * std::sin(23 * x) * std::sin(19 * z), z);
  });
  return std::move(b.scene);
}

TEST(VertexLight, DenseCrumpledMeshesKeepTheirLightByVertex) {
  struct Case {
    int quads;
    float bump, texels;
    bool byVertex;
  };
  for (const Case& c : {Case{96, 0.06f, 4e4f, true}, Case{96, 0, 4e4f, false}, Case{96, 0.06f, 1e6f, false},
                        Case{40, 0.06f, 4e4f, false}}) {
    const core::Scene scene = floorAndPatch(c.quads, c.bump);
    ChartLayout layout(scene, c.texels, VertexLight::whereItPays);
    EXPECT_EQ(layout.vertexLitMeshes(), c.byVertex ? 1u : 0u) << c.quads << ' ' << c.bump << ' ' << c.texels;
    ASSERT_TRUE(layout.pack(std::vector<double>(layout.items().size(), 0.1), 512));
    const core::SceneCharts charts = layout.cut(512);
    EXPECT_FALSE(charts.meshes[0].perVertex);
    EXPECT_EQ(charts.meshes[1].perVertex, c.byVertex);
    EXPECT_EQ(ChartLayout(scene, c.texels).vertexLitMeshes(), 0u);
  }
}

/// Vertices' texels lie in no other chart and have a border of their own, whatever texels others have.
TEST(VertexLight, BlocksOfVerticesLieApart) {
  constexpr int kSide = 320;
  core::Scene scene = floorAndPatch(96, 0.06f);
  ChartLayout layout(scene, 4e4, VertexLight::whereItPays);
  ASSERT_TRUE(layout.pack(std::vector<double>(layout.items().size(), 0.06), kSide));
  core::applyCharts(scene, layout.cut(kSide));
  const TexelMap texels(scene, kSide);
  std::size_t byVertex = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0 || !texels.charts()[static_cast<std::size_t>(texels.chartOf(t))].byVertex)
      continue;
    ++byVertex;
    for (const TexelFragment& f : texels.fragments(t)) EXPECT_EQ(f.object, 1u);
    for (const std::size_t near :
         {t - kSide - 1, t - kSide, t - kSide + 1, t - 1, t + 1, t + kSide - 1, t + kSide, t + kSide + 1}) {
      const std::int32_t chart = texels.chartOf(near);
      EXPECT_TRUE(chart < 0 || chart == texels.chartOf(t)) << t;
    }
  }
  EXPECT_EQ(byVertex, vertexTexels(scene.meshes[1]).count);
}

TEST(VertexLight, AFurnaceIsEven) {
  for (const float albedo : {0.5f, 0.9f}) {
    Builder b;
    addSphere(b, Builder::matte(albedo, Vec3(1)), 1, 24, true);
    const Bake baked(std::move(b.scene), optionsOf("high"));
    const double expected = core::kPi / (1 - double{albedo});
    double mean = 0, squares = 0;
    const std::vector<SurfacePoint> points = surfacePoints(*baked.world, 1000, 1);
    for (const SurfacePoint& p : points) {
      const double error = mapIrradiance(*baked.world, p).y / expected - 1;
      mean += error / static_cast<double>(points.size());
      squares += error * error / static_cast<double>(points.size());
    }
    EXPECT_NEAR(mean, 0, 0.005) << albedo;
    EXPECT_LT(std::sqrt(squares), 0.005) << albedo;
  }
}

TEST(VertexLight, ASphereUnderALampShowsTheCosineLaw) {
  Builder b;
  addSphere(b, Builder::matte(1e-3f), 1, 32, false);
  core::PunctualLight lamp;
  lamp.type = core::PunctualLight::Type::point;
  lamp.position = Vec3(0.5f, 3, 1);
  lamp.intensity = Vec3(20);
  b.scene.lights.push_back(lamp);
  const Bake baked(std::move(b.scene), optionsOf("high"));
  double squares = 0, sum = 0;
  const std::vector<SurfacePoint> points = surfacePoints(*baked.world, 2000, 1);
  for (const SurfacePoint& p : points) {
    const Vec3 n = glm::normalize(surfaceOn(*baked.world, 0, p.triangle, p.b1, p.b2, true).position);
    const Vec3 way = lamp.position - n;
    const double d = glm::length(way), expected = 20 * std::max(0.0, double{glm::dot(n, way)} / d) / (d * d);
    const double error = mapIrradiance(*baked.world, p).y - expected;
    squares += error * error;
    sum += expected;
  }
  const double count = static_cast<double>(points.size());
  EXPECT_LT(std::sqrt(squares / count) / (sum / count), 0.02);
}

}  // namespace
}  // namespace saccade::raytrace
