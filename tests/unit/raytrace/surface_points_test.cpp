// Seeded points and their path-traced irradiance: what illumination maps are measured against.
#include "raytrace/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bake_scenes.h"
#include "irradiance.h"
#include "raytrace/path_tracer.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;

core::Scene litFloor() {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.5f), Vec3(-1, 0, -1), Vec3(0, 0, 2), Vec3(2, 0, 0));
  b.quad(SceneBuilder::matte(0, Vec3(4)), Vec3(-0.5f, 1, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1));
  return std::move(b.scene);
}

Vec3 positionOf(const World& world, const SurfacePoint& p) {
  const TriangleShape& s = world.shape(world.firstTriangle(p.object) + p.triangle);
  return s.position[0] * (1 - p.b1 - p.b2) + s.position[1] * p.b1 + s.position[2] * p.b2;
}

TEST(SurfacePoints, FollowTheAreaAndCountBothSidesOfSheets) {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.5f), Vec3(0), Vec3(0, 0, 1), Vec3(3, 0, 0));
  core::Material sheet = SceneBuilder::matte(0.5f);
  sheet.doubleSided = true;
  b.quad(sheet, Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0));
  const World world(b.scene, {});
  std::map<std::pair<std::uint32_t, bool>, int> count;
  for (const SurfacePoint& p : surfacePoints(world, 5000, 3)) ++count[{p.object, p.front}];
  EXPECT_NEAR((count[{0, true}]), 3000, 1);  // 3 of 5 square metres, in strata
  EXPECT_EQ((count[{0, false}]), 0);
  const double sigma = std::sqrt(2000 * 0.25);
  EXPECT_NEAR((count[{1, true}]), 1000, 4 * sigma);
  EXPECT_NEAR((count[{1, false}]), 1000, 4 * sigma);
}

TEST(SurfacePoints, AreTheSameForTheSameSeedAndSpreadOverTriangles) {
  const core::Scene scene = litFloor();
  const World world(scene, {});
  const auto a = surfacePoints(world, 4096, 1), again = surfacePoints(world, 4096, 1);
  glm::dvec3 mean(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(positionOf(world, a[i]), positionOf(world, again[i]));
    if (a[i].object == 0) mean += glm::dvec3(positionOf(world, a[i]));
  }
  // Black surfaces show no irradiance: all points lie on the floor, whose mean is the origin.
  mean /= static_cast<double>(a.size());
  const double sigma = std::sqrt(4.0 / 12 / 4096);
  EXPECT_NEAR(mean.x, 0, 4 * sigma);
  EXPECT_NEAR(mean.z, 0, 4 * sigma);
}

TEST(PathIrradiance, EqualsLambertsFormulaAndStatesItsVariance) {
  const core::Scene scene = litFloor();
  const World world(scene, {});
  const std::vector<Vec3> lamp = {Vec3(-0.5f, 1, -0.5f), Vec3(0.5f, 1, -0.5f), Vec3(0.5f, 1, 0.5f),
                                  Vec3(-0.5f, 1, 0.5f)};
  PathOptions options;
  options.samplesPerPixel = 256;
  double chi2 = 0;
  const auto points = surfacePoints(world, 400, 5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    RayCounters counters;
    const IrradianceEstimate e =
        pathIrradiance(world, points[i], static_cast<std::uint32_t>(i), options, counters);
    const double truth = 4 * polygonIrradiance(positionOf(world, points[i]), Vec3(0, 1, 0), lamp);
    const double off = static_cast<double>(e.mean.x) - truth;
    chi2 += off * off / static_cast<double>(e.variance.x);
  }
  EXPECT_NEAR(chi2 / 400, 1, 4 * std::sqrt(2.0 / 400));
}

TEST(PathIrradiance, OfAClosedFurnaceIsTheGeometricSeries) {
  SceneBuilder b;
  b.box(SceneBuilder::matte(0.5f, Vec3(1)), Vec3(0), Vec3(1), true);
  const World world(b.scene, {});
  PathOptions options;
  options.samplesPerPixel = 4096;
  options.bounces = 64;
  RayCounters counters;
  const IrradianceEstimate e =
      pathIrradiance(world, surfacePoints(world, 1, 1).front(), 0, options, counters);
  EXPECT_NEAR(e.mean.x, 2 * core::kPi, 4 * std::sqrt(e.variance.x) + 1e-4);  // E = pi Le / (1 - albedo)
  EXPECT_LT(std::sqrt(e.variance.x), 0.02 * e.mean.x);
}

}  // namespace
}  // namespace saccade::raytrace
