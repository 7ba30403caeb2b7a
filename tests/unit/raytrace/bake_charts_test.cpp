// Charts: complete, apart, oriented, close to the true areas, deterministic.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "raytrace/bake/cell_clip.h"
#include "raytrace/bake/charts.h"

namespace saccade::raytrace {
namespace {

using core::Vec2;
using core::Vec3;

core::Scene sceneOf(std::vector<core::Mesh> meshes) {
  core::Scene scene;
  core::Material white;
  white.metallic = 0;
  scene.materials.push_back(white);
  for (core::Mesh& m : meshes) {
    core::Object object;
    object.name = "mesh";
    m.normals.assign(m.positions.size(), Vec3(0, 1, 0));
    scene.add(std::move(object), std::move(m));
  }
  return scene;
}

core::Plan planOf(int size) {
  core::Plan plan;
  plan.lightmapSize = size;
  return plan;
}

/// A grid of quads over [0, 1]^2 put into space by `place`.
template <class Place>
core::Mesh gridMesh(int nx, int ny, Place&& place) {
  core::Mesh mesh;
  for (int y = 0; y <= ny; ++y) {
    for (int x = 0; x <= nx; ++x) mesh.positions.push_back(place(float(x) / nx, float(y) / ny));
  }
  const auto v = [&](int x, int y) { return static_cast<std::uint32_t>(y * (nx + 1) + x); };
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      for (std::uint32_t i : {v(x, y), v(x + 1, y), v(x + 1, y + 1), v(x, y), v(x + 1, y + 1), v(x, y + 1)}) {
        mesh.indices.push_back(i);
      }
    }
  }
  return mesh;
}

core::Mesh sphere(int n) {
  return gridMesh(2 * n, n, [](float s, float t) {
    const float a = 2 * core::kPi * (s < 1 ? s : 0), b = core::kPi * t;
    return Vec3(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
  });
}

/// Three turns of a ramp: flat enough for one chart, yet above itself.
core::Mesh spiralRamp() {
  return gridMesh(120, 3, [](float s, float t) {
    const float a = 6 * core::kPi * s, r = 1 + t;
    return Vec3(r * std::cos(a), s * 2, r * std::sin(a));
  });
}

core::Mesh manyPieces(int count) {
  core::Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 at(static_cast<float>(i % 50), 0, static_cast<float>(i / 50));
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 d : {Vec3(0), Vec3(0, 0, 0.01f), Vec3(0.01f, 0, 0)}) mesh.positions.push_back(at + d);
    for (std::uint32_t k = 0; k < 3; ++k) mesh.indices.push_back(base + k);
  }
  return mesh;
}

struct Area {
  double world = 0, atlas = 0;  // m^2, texels
};

Area areaOf(const core::Mesh& mesh, const core::MeshCharts& charts, std::size_t t, int size) {
  glm::dvec3 p[3];
  glm::dvec2 q[3];
  for (std::size_t c = 0; c < 3; ++c) {
    p[c] = mesh.positions[mesh.indices[3 * t + c]];
    q[c] = glm::dvec2(charts.uv[charts.indices[3 * t + c]]) * double(size);
  }
  const glm::dvec2 e = q[1] - q[0], f = q[2] - q[0];
  return {0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])), 0.5 * (e.x * f.y - e.y * f.x)};
}

/// All promises of makeCharts but determinism.
void checkCharts(const core::Scene& scene, const ChartAtlas& atlas) {
  ASSERT_EQ(atlas.charts.meshes.size(), scene.meshes.size());
  ASSERT_EQ(atlas.charts.places.size(), scene.objects.size());
  std::map<int, double> filled;  // texel -> covered share
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const core::Mesh& mesh = scene.meshOf(scene.objects[o]);
    const core::MeshCharts& charts = atlas.charts.meshes[o];
    ASSERT_EQ(charts.indices.size(), mesh.indices.size());
    ASSERT_EQ(charts.uv.size(), charts.sourceVertex.size());
    for (const Vec2& uv : charts.uv) {
      ASSERT_TRUE(uv.x > 0 && uv.x < 1 && uv.y > 0 && uv.y < 1) << uv.x << ' ' << uv.y;
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      ASSERT_LT(charts.indices[i], charts.sourceVertex.size());
      ASSERT_EQ(charts.sourceVertex[charts.indices[i]], mesh.indices[i]) << "triangle order kept";
    }
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const Area area = areaOf(mesh, charts, t, atlas.size);
      if (area.world > 0) {
        EXPECT_GE(area.atlas, -1e-4) << "triangle " << t << " is turned over";
      }
      const auto corner = [&](std::size_t c) {
        return Plane2(charts.uv[charts.indices[3 * t + c]]) * double(atlas.size);
      };
      forEachCell(corner(0), corner(1), corner(2), atlas.size, atlas.size,
                  [&](int x, int y, double a) { filled[y * atlas.size + x] += a; });
    }
  }
  for (const auto& [texel, share] : filled) ASSERT_LE(share, 1.01) << "charts overlap in texel " << texel;
}

TEST(BakeCharts, EveryShapeIsCutCompletelyApartAndOriented) {
  const core::Scene scene =
      sceneOf({sphere(24), spiralRamp(), manyPieces(300),
               gridMesh(1, 1, [](float s, float t) { return Vec3(7 * s, 0, -4 * t); })});
  checkCharts(scene, makeCharts(scene, planOf(512), 2048));
}

TEST(BakeCharts, CurvedSurfacesGetFewChartsAndFlatOnesKeepTheirShape) {
  const core::Scene ball = sceneOf({sphere(32)});
  const ChartAtlas ballAtlas = makeCharts(ball, planOf(256), 256);
  EXPECT_LE(ballAtlas.chartCount, 24u);
  EXPECT_GE(ballAtlas.chartCount, 5u);  // 40 degrees around an axis is 0.117 of the sphere

  const core::Scene wall =
      sceneOf({gridMesh(40, 30, [](float s, float t) { return Vec3(8 * s, 5 * t, 0); })});
  const ChartAtlas wallAtlas = makeCharts(wall, planOf(256), 256);
  EXPECT_EQ(wallAtlas.chartCount, 1u);
  for (std::size_t t = 0; t < wall.meshes[0].triangleCount(); ++t) {
    const Area a = areaOf(wall.meshes[0], wallAtlas.charts.meshes[0], t, wallAtlas.size);
    EXPECT_NEAR(a.atlas * wallAtlas.texelMetres * wallAtlas.texelMetres / a.world, 1, 0.02);
  }
}

TEST(BakeCharts, AreasShrinkByAtMostTheConeAndTheRoundingToTexels) {
  const core::Scene scene = sceneOf({sphere(48)});
  const ChartAtlas atlas = makeCharts(scene, planOf(512), 512);
  for (std::size_t t = 0; t < scene.meshes[0].triangleCount(); ++t) {
    const Area a = areaOf(scene.meshes[0], atlas.charts.meshes[0], t, atlas.size);
    if (a.world < 1e-7) continue;
    const double ratio = a.atlas * atlas.texelMetres * atlas.texelMetres / a.world;
    EXPECT_GT(ratio, 0.55);
    EXPECT_LT(ratio, 1.1);
  }
}

TEST(BakeCharts, ARampAboveItselfIsSplit) {
  const core::Scene scene = sceneOf({spiralRamp()});
  const ChartAtlas atlas = makeCharts(scene, planOf(512), 512);
  EXPECT_GE(atlas.chartCount, 3u);
  checkCharts(scene, atlas);
}

TEST(BakeCharts, SharpEdgesEndAChart) {
  core::Mesh fold = gridMesh(2, 1, [](float s, float t) {
    return s < 0.75f ? Vec3(s, 0, -t) : Vec3(0.5f, s - 0.5f, -t);  // the last column stands upright
  });
  EXPECT_EQ(makeCharts(sceneOf({fold}), planOf(64), 64).chartCount, 2u);
}

TEST(BakeCharts, ThousandsOfPiecesGetATexelEachAndTheAtlasGrowsForThem) {
  const core::Scene scene = sceneOf({manyPieces(3000)});
  const ChartAtlas atlas = makeCharts(scene, planOf(128), 1024);
  EXPECT_EQ(atlas.chartCount, 3000u);
  EXPECT_GT(atlas.size, 128);
  checkCharts(scene, atlas);
  EXPECT_THROW(makeCharts(scene, planOf(64), 64), core::Error);
}

TEST(BakeCharts, ObjectsThatShowNoIrradianceShareOneTexel) {
  core::Scene scene = sceneOf({sphere(16), gridMesh(4, 4, [](float s, float t) { return Vec3(s, 0, -t); })});
  core::Material metal;
  metal.metallic = 1;
  scene.materials.push_back(metal);
  scene.objects[0].material = 1;
  const ChartAtlas atlas = makeCharts(scene, planOf(64), 64);
  EXPECT_EQ(atlas.chartCount, 2u);
  for (const Vec2& uv : atlas.charts.meshes[0].uv) EXPECT_EQ(uv, atlas.charts.meshes[0].uv[0]);
  EXPECT_EQ(atlas.charts.meshes[0].indices, scene.meshes[0].indices);
}

TEST(BakeCharts, DegenerateTrianglesSurvive) {
  core::Mesh mesh = gridMesh(2, 2, [](float s, float t) { return Vec3(s, 0, -t); });
  const float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.positions.push_back(Vec3(nan, 0, 0));
  const auto bad = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t i : {0u, 0u, 0u, 0u, 1u, 0u, 0u, 1u, 2u, bad, 0u, 1u}) mesh.indices.push_back(i);
  const core::Scene scene = sceneOf({mesh, core::Mesh{}});
  const ChartAtlas atlas = makeCharts(scene, planOf(64), 64);
  ASSERT_EQ(atlas.charts.meshes[0].indices.size(), mesh.indices.size());
  for (const Vec2& uv : atlas.charts.meshes[0].uv) ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
  EXPECT_TRUE(atlas.charts.meshes[1].indices.empty());
}

TEST(BakeCharts, TheSameSceneGivesTheSameCharts) {
  const core::Scene scene = sceneOf({sphere(20), spiralRamp(), manyPieces(100)});
  const ChartAtlas a = makeCharts(scene, planOf(256), 512), b = makeCharts(scene, planOf(256), 512);
  ASSERT_EQ(a.size, b.size);
  for (std::size_t o = 0; o < a.charts.meshes.size(); ++o) {
    EXPECT_EQ(a.charts.meshes[o].sourceVertex, b.charts.meshes[o].sourceVertex);
    EXPECT_EQ(a.charts.meshes[o].indices, b.charts.meshes[o].indices);
    EXPECT_EQ(a.charts.meshes[o].uv, b.charts.meshes[o].uv);
  }
}

TEST(CellClip, CellAreasAddUpToTheTriangle) {
  const Plane2 a(0.3, 0.2), b(9.7, 3.1), c(2.2, 8.9);
  const double whole = 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  double sum = 0, largest = 0;
  forEachCell(a, b, c, 10, 10, [&](int, int, double area) {
    sum += area;
    largest = std::max(largest, area);
  });
  EXPECT_NEAR(sum, whole, 1e-12 * whole);
  EXPECT_NEAR(largest, 1.0, 1e-12);  // inner cells are whole
}

}  // namespace
}  // namespace saccade::raytrace
