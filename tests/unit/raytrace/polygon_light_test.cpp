// Lambert's formula and the directions towards a polygon, against truths of their own.
#include "raytrace/bake/polygon_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "raytrace/bsdf.h"
#include "tests/unit/raytrace/irradiance.h"

namespace saccade::raytrace {
namespace {

Vec3 anyDirection(std::mt19937& engine) {
  std::normal_distribution<float> g;
  return glm::normalize(Vec3(g(engine), g(engine), g(engine)));
}

TEST(PolygonLight, EqualsLambertsFormulaInDoubleAtAnySizeAndHorizon) {
  std::mt19937 engine(1);
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    const float size = std::pow(10.0f, -3 + 4 * static_cast<float>(engine()) / 0x1p32f);
    const Vec3 corner[3] = {size * anyDirection(engine) + Vec3(0, 1, 0), size * anyDirection(engine),
                            anyDirection(engine)};
    const Vec3 normal = anyDirection(engine);
    const double truth = polygonIrradiance(Vec3(0), normal, {corner[0], corner[1], corner[2]});
    const float found = projectedSolidAngle(aboveHorizons(corner, Vec3(0), normal, normal), normal);
    ASSERT_NEAR(found, truth, 2e-5 + 1e-5 * truth) << i;  // angles near pi in float
    seen += truth > 0.01;
  }
  EXPECT_GT(seen, 5000);
}

TEST(PolygonLight, WeightsOfDirectionsAverageToOneAndAllHitTheTriangleAboveBothHorizons) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(0, 1);
  int polygons = 0;
  while (polygons < 60) {
    const Vec3 corner[3] = {2.0f * anyDirection(engine), anyDirection(engine), anyDirection(engine)};
    const Vec3 ng = anyDirection(engine), normal = glm::normalize(ng + 0.3f * anyDirection(engine));
    const SkyPolygon sky = aboveHorizons(corner, Vec3(0), ng, normal);
    if (projectedSolidAngle(sky, normal) < 1e-3f) continue;
    ++polygons;
    double sum = 0, squares = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const SkyDirection d = sampleSky(sky, normal, {u(engine), u(engine)});
      ASSERT_GE(glm::dot(d.direction, ng), -1e-5f);
      ASSERT_GE(glm::dot(d.direction, normal), -1e-5f);
      for (int k = 0; k < 3; ++k) {  // inside: the same side of the planes through the point and each edge
        const Vec3 plane = glm::normalize(glm::cross(corner[k], corner[(k + 1) % 3]));
        ASSERT_GE(glm::dot(plane, d.direction) * std::copysign(1.0f, glm::dot(plane, corner[(k + 2) % 3])),
                  -1e-4f);
      }
      sum += d.weight;
      squares += double{d.weight} * d.weight;
    }
    const double mean = sum / n, sigma = std::sqrt((squares / n - mean * mean) / n);
    ASSERT_NEAR(mean, 1, 5 * sigma + 1e-4);
  }
}

TEST(PolygonLight, Hard17NothingAtGrazingBehindOrWithoutArea) {
  const Vec3 up(0, 1, 0);
  const Vec3 below[3] = {Vec3(0, -1, 0), Vec3(1, -1, 0), Vec3(0, -2, 1)};
  const Vec3 grazing[3] = {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 1)};
  const Vec3 needle[3] = {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(2, 1, 0)};
  for (const auto* t : {&below, &grazing}) EXPECT_EQ(aboveHorizons(*t, Vec3(0), up, up).count, 0);
  const SkyPolygon sky = aboveHorizons(needle, Vec3(0), up, up);
  EXPECT_NEAR(projectedSolidAngle(sky, up), 0, 1e-6);
}

}  // namespace
}  // namespace saccade::raytrace
