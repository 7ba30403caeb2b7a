// Maps of quality high against closed-form light between diffuse plates and in furnaces, and against paths.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "core/math/random.h"
#include "raytrace/path_tracer.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using tests::HardCase;
using Builder = SceneBuilder;

/// Reflects so little that nothing of it comes back, but shows its light.
constexpr float kNearlyBlack = 1e-3f;

BakeOptions high(std::uint64_t photons) {
  BakeOptions o;
  o.quality = "high";
  o.photons = photons;
  o.threads = 2;
  return o;
}

/// What an error is: of the mean, and the root mean square over the mean, over points of objects [0, count).
struct Deviation {
  double mean = 0, rms = 0;
};

/// `truth` of points spread over the quads of objects [first, last).
Deviation deviation(const Baked& baked, int first, int last,
                    const std::function<double(const Vec3&)>& truth) {
  constexpr int kPoints = 1500;
  double error = 0, squares = 0, sum = 0;
  for (int o = first; o < last; ++o) {
    const core::Mesh& mesh = baked.scene().meshOf(baked.scene().objects[static_cast<std::size_t>(o)]);
    const Vec3 corner = mesh.positions[0], u = mesh.positions[1] - corner, v = mesh.positions[2] - corner - u;
    for (int i = 0; i < kPoints; ++i) {
      core::PixelSampler random(7, static_cast<std::uint32_t>(o), static_cast<std::uint64_t>(i), 1);
      const core::Vec2 at = random.next2D();
      const Vec3 p = corner + at.x * u + at.y * v;
      const double expected = truth(p), d = baked.irradiance(o, p).y - expected;
      error += d;
      squares += d * d;
      sum += expected;
    }
  }
  const double n = static_cast<double>(last - first) * kPoints;
  return {error / sum, std::sqrt(squares / n) / (sum / n)};
}

/// Light that falls along `direction` with an irradiance of 4 on what faces it.
void addSun(Builder& b, const Vec3& direction) {
  core::PunctualLight sun;
  sun.type = core::PunctualLight::Type::directional;
  sun.direction = glm::normalize(direction);
  sun.intensity = Vec3(4);
  b.scene.lights.push_back(sun);
}

/// Form factor from a point to a rectangle in a parallel plane at distance h, a corner right above the point.
double cornerAbove(double a, double b, double h) {
  const double x = a / h, y = b / h;
  return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
          y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
         (2 * core::kPi);
}

/// The same to one in a perpendicular plane that the point is c above; its near edge, b long, lies under the
/// point and ends there, its depth is a.
double cornerBeside(double a, double b, double c) {
  const double far = std::sqrt(a * a + c * c);
  return (std::atan(b / c) - c / far * std::atan(b / far)) / (2 * core::kPi);
}

TEST(BakeTruth, Hard8AParallelPlateIsLitByTheOtherWithinHalfAPercent) {
  Builder b;  // the sun comes in below the upper plate, whose front looks down on the lower one
  b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  const int upper = b.quad(Builder::matte(kNearlyBlack), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1));
  addSun(b, Vec3(2, -1, 0));
  const double sent = 0.5 * 4 / std::sqrt(5.0);
  const Baked baked(std::move(b.scene), 192, high(4096));
  const Deviation d = deviation(baked, upper, upper + 1, [&](const Vec3& p) {
    return sent * (cornerAbove(p.x, p.z, 1) + cornerAbove(1 - p.x, p.z, 1) + cornerAbove(p.x, 1 - p.z, 1) +
                   cornerAbove(1 - p.x, 1 - p.z, 1));
  });
  EXPECT_TRUE(HardCase("plate lit by a parallel one in the maps, mean").near(1 + d.mean, 1, 0.005));
  EXPECT_TRUE(HardCase("plate lit by a parallel one in the maps, RMS").within(d.rms, 0.005));
}

TEST(BakeTruth, Hard8APerpendicularPlateIsLitByTheOtherWithinHalfAPercent) {
  Builder b;  // a lit floor and a wall on its edge
  b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  const int wall = b.quad(Builder::matte(kNearlyBlack), Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  addSun(b, Vec3(0, -1, 0));
  const Baked baked(std::move(b.scene), 192, high(4096));
  const Deviation d = deviation(baked, wall, wall + 1, [](const Vec3& p) {
    return 0.5 * 4 * (cornerBeside(1, p.x, p.y) + cornerBeside(1, 1 - p.x, p.y));
  });
  EXPECT_TRUE(HardCase("plate lit by a perpendicular one in the maps, mean").near(1 + d.mean, 1, 0.005));
  EXPECT_TRUE(HardCase("plate lit by a perpendicular one in the maps, RMS").within(d.rms, 0.005));
}

TEST(BakeTruth, Hard10ClosedFurnacesWithinHalfAPercent) {
  for (const float albedo : {0.2f, 0.5f, 0.9f}) {
    Builder b;  // every wall glows with 1 / pi and reflects the albedo
    b.box(Builder::matte(albedo, Vec3(1 / core::kPi)), Vec3(0), Vec3(1, 1.2f, 0.8f), true);
    const Baked baked(std::move(b.scene), 64, high(1 << 21));
    const Deviation d = deviation(baked, 0, 6, [&](const Vec3&) { return 1 / (1 - albedo); });
    const std::string name = "closed furnace of albedo " + std::to_string(albedo).substr(0, 3);
    EXPECT_TRUE(HardCase(name + " in the maps at high, mean").near(1 + d.mean, 1, 0.005));
    EXPECT_TRUE(HardCase(name + " in the maps at high, RMS").within(d.rms, 0.005));
  }
}

TEST(BakeTruth, AMirrorWallLosesAndDoublesNoLight) {
  Builder b;  // five walls glow and reflect one half, the sixth is a mirror: E = 1 / (1 - 0.5) on the five
  b.box(Builder::matte(0.5f, Vec3(1 / core::kPi)), Vec3(0), Vec3(1), true);
  core::Material mirror = Builder::matte(1);
  mirror.metallic = 1;
  mirror.roughness = 0;
  b.scene.materials.back() = mirror;
  const Baked baked(std::move(b.scene), 64, high(1 << 21));
  const Deviation d = deviation(baked, 0, 5, [](const Vec3&) { return 2; });
  EXPECT_NEAR(d.mean, 0, 0.005);
  EXPECT_LT(d.rms, 0.02);
}

TEST(BakeTruth, ARoughMetalAndAGlossyWallAgreeWithPathsWithinOnePercent) {
  Builder b;
  b.box(Builder::matte(0.5f), Vec3(0), Vec3(1), true);
  core::Material metal = Builder::matte(0.9f);
  metal.metallic = 1;
  metal.roughness = 0.4f;
  b.scene.materials.back() = metal;
  core::Material glossy = Builder::matte(0.6f);
  glossy.specular = 1;
  glossy.roughness = 0.3f;
  b.scene.materials[static_cast<std::size_t>(b.scene.objects[4].material)] = glossy;
  b.quad(Builder::matte(0, Vec3(10)), Vec3(0.3f, 0.99f, 0.3f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  const Baked baked(std::move(b.scene), 64, high(1 << 21));
  PathOptions paths;
  paths.samplesPerPixel = 512;
  paths.bounces = 64;
  double map = 0, path = 0;
  RayCounters counters;
  const std::vector<SurfacePoint> points = surfacePoints(baked.world(), 128, 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    map += mapIrradiance(baked.world(), points[i]).y;
    path += pathIrradiance(baked.world(), points[i], i, paths, counters).mean.y;
  }
  EXPECT_NEAR(map / path, 1, 0.01);
}

}  // namespace
}  // namespace saccade::raytrace
