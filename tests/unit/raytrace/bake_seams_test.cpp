// Look-ups from both sides of chart borders: they agree, and with the light that is truly there.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bake_scenes.h"
#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/seams.h"

namespace saccade::raytrace {
namespace {

using core::Vec2;
using core::Vec3;

/// Half a cylinder of radius 1 along x, seen from inside: several charts.
void halfCylinder(SceneBuilder& b, float length, float albedo) {
  b.patch(SceneBuilder::matte(albedo), 8, 96, [=](float s, float t) {
    const float a = core::kPi * (1 - t);
    return Vec3(length * s, std::sin(a), std::cos(a));
  });
}

struct Charted {
  core::Scene scene;
  int size = 256;

  /// Texel sides in metres by item, in turn.
  Charted(core::Scene loaded, const std::vector<double>& sides) : scene(std::move(loaded)) {
    ChartLayout layout(scene);
    std::vector<double> texels;
    for (std::size_t i = 0; i < layout.items().size(); ++i) texels.push_back(sides[i % sides.size()]);
    EXPECT_TRUE(layout.pack(texels, size));
    core::applyCharts(scene, layout.cut(size));
  }
  Vec3 pointAt(const MeshPoint& p) const {
    const core::Mesh& mesh = scene.meshOf(scene.objects[p.object]);
    const auto corner = [&](std::size_t k) { return mesh.positions[mesh.indices[3 * p.triangle + k]]; };
    return corner(0) * (1 - p.b1 - p.b2) + corner(1) * p.b1 + corner(2) * p.b2;
  }
};

/// Each texel's mean of a function of the surface, as a bake without noise has it.
std::vector<Vec3> meansOf(const Charted& c, const TexelMap& texels, const std::function<float(Vec3)>& light) {
  std::vector<Vec3> out(texels.texelCount(), Vec3(-1));
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (texels.chartOf(i) < 0 || !(texels.area(i) > 0)) continue;
    double sum = 0;
    constexpr int kSide = 8;
    for (int k = 0; k < kSide * kSide * kSide; ++k) {
      const auto u = [&](int d) { return (static_cast<float>(k / d % kSide) + 0.5f) / kSide; };
      sum += static_cast<double>(light(c.pointAt(texels.pointOn(i, u(1), u(kSide), u(kSide * kSide)))));
    }
    out[i] = Vec3(static_cast<float>(sum / (kSide * kSide * kSide)));
  }
  return out;
}

float lookUp(const std::vector<Vec3>& texels, int size, const Plane2& p) {
  const double x = p.x - 0.5, y = p.y - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto at = [&](int i, int j) {
    return double{
        texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(size) + static_cast<std::size_t>(i)].x};
  };
  return static_cast<float>(glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), x - x0),
                                     glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), x - x0), y - y0));
}

/// Largest difference of the two sides at points of the seams, over the light there.
template <class Read>
double largestDifference(const std::vector<Seam>& seams, Read&& read) {
  double largest = 0;
  for (const Seam& seam : seams) {
    for (int i = 0; i < 9; ++i) {
      const double s = (i + 0.5) / 9;
      const double a = read(glm::mix(seam.from[0], seam.to[0], s)),
                   b = read(glm::mix(seam.from[1], seam.to[1], s));
      largest = std::max(largest, std::abs(a - b) / std::max(a, b));
    }
  }
  return largest;
}

/// Largest error at the mesh's vertices, those on the borders twice: they belong to both sides' charts.
template <class Read>
double largestError(const core::Mesh& mesh, double size, const std::function<float(Vec3)>& light,
                    Read&& read) {
  double largest = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double truth = light(mesh.positions[v]);
    largest = std::max(largest, std::abs(read(Plane2(mesh.lightmapUv[v]) * size) - truth) / truth);
  }
  return largest;
}

TEST(BakeSeams, ACurvedWallUnderOneLightShowsNoChartBorders) {
  SceneBuilder b;
  halfCylinder(b, 2, 0.01f);  // next to no indirect light
  const Vec3 lamp(1, 0.1f, 0.3f);
  core::PunctualLight light;
  light.position = lamp;
  light.intensity = Vec3(5);
  b.scene.lights.push_back(light);
  BakeOptions options;
  options.quality = "preview";
  const Baked baked(b.scene, 128, options);
  const double size = baked.maps().width;
  const TexelMap texels(baked.scene(), baked.maps().width);
  const std::vector<Seam> seams = findSeams(texels);
  EXPECT_GT(seams.size(), 12u);
  const auto read = [&](const Plane2& p) { return double{baked.world().irradiance(Vec2(p / size), 0).x}; };
  EXPECT_LT(largestDifference(seams, read), 0.01);
  const auto truth = [&](Vec3 p) {
    const Vec3 to = lamp - p, n = glm::normalize(Vec3(0, -p.y, -p.z));
    return 5 * glm::dot(to, n) / std::pow(glm::dot(to, to), 1.5f);
  };
  EXPECT_LT(largestError(baked.scene().meshes[0], size, truth, read), 0.03);
}

TEST(BakeSeams, ChartsOfDifferentDensityAgreeAlongSmoothBorders) {
  SceneBuilder b;
  halfCylinder(b, 2, 0.5f);
  for (const std::vector<double>& sides :
       {std::vector<double>{0.05}, std::vector<double>{0.05, 0.02}, std::vector<double>{0.02, 0.08, 0.04}}) {
    const Charted c(b.scene, sides);
    const TexelMap texels(c.scene, c.size);
    const auto light = [](Vec3 p) { return 2 + std::sin(2 * p.x + 1) * (0.5f + p.y) + 0.4f * p.z; };
    std::vector<Vec3> irradiance = meansOf(c, texels, light);
    const auto read = [&](const Plane2& p) { return double{lookUp(irradiance, c.size, p)}; };
    fillGutters(texels, irradiance);
    const std::vector<Seam> seams = findSeams(texels);
    ASSERT_GT(seams.size(), 12u);
    const double unstitched = largestDifference(seams, read);
    stitchSeams(seams, c.size, false, irradiance);
    EXPECT_LT(largestDifference(seams, read), 0.01);
    EXPECT_LT(largestDifference(seams, read), 0.5 * unstitched);
    EXPECT_LT(largestError(c.scene.meshes[0], c.size, light, read), 0.02);
  }
}

TEST(BakeSeams, LinearLightIsExactUpToTheBorders) {
  // A triangle's slanted sides cut texels: their means lie inside, look-ups at the border must not.
  SceneBuilder b;
  b.patch(SceneBuilder::matte(0.5f), 1, 12,
          [](float s, float t) { return Vec3(t, 0, (s - 0.5f) * (0.6f + t)); });
  const Charted c(b.scene, {0.05});
  const TexelMap texels(c.scene, c.size);
  const auto light = [](Vec3 p) { return 3 + 2 * p.x - p.z; };
  std::vector<Vec3> irradiance = meansOf(c, texels, light);
  fillGutters(texels, irradiance);
  const auto read = [&](const Plane2& p) { return double{lookUp(irradiance, c.size, p)}; };
  EXPECT_LT(largestError(c.scene.meshes[0], c.size, light, read), 0.01);
}

TEST(BakeSeams, AStepOnASeamStays) {
  SceneBuilder b;
  halfCylinder(b, 2, 0.5f);
  const Charted c(b.scene, {0.05});
  const TexelMap texels(c.scene, c.size);
  std::vector<Vec3> irradiance(texels.texelCount());
  for (std::size_t i = 0; i < irradiance.size(); ++i)
    irradiance[i] = Vec3(texels.chartOf(i) == 0 ? 4.0f : texels.chartOf(i) > 0 ? 1.0f : 0.0f);
  fillGutters(texels, irradiance);
  const std::vector<Vec3> before = irradiance;
  stitchSeams(findSeams(texels), c.size, false, irradiance);
  for (std::size_t i = 0; i < irradiance.size(); ++i) EXPECT_NEAR(irradiance[i].x, before[i].x, 1e-4f);
}

}  // namespace
}  // namespace saccade::raytrace
