// Numerics 3 of the hard cases: no self-shadow and no leak, near and far, small and large.
#include <gtest/gtest.h>

#include <random>

#include "raytrace/path_tracer.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;
using tests::planOf;
using tests::SceneMaker;

constexpr float kDistances[] = {0.0f, 1.0f, 100.0f, 10000.0f};  ///< from the origin, in units of the body
constexpr int kExponents[] = {-20, -10, 10, 20};

/// Rays that leave a convex body outwards and meet it, and those inwards that do not.
struct SelfHits {
  int met = 0, missed = 0;
};
SelfHits selfHits(const Vec3& center, float radius) {
  SceneMaker m;
  const int material = m.material(tests::diffuseMaterial(Vec3(1)));
  m.sphere(material, 0, center, radius);
  m.box(material, 0, center + Vec3(3 * radius), center + Vec3(4 * radius));
  const World world(m.scene, planOf());
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(0, 1);
  RayCounters counters;
  SelfHits hits;
  for (int i = 0; i < 20000; ++i) {
    const auto triangle = static_cast<std::uint32_t>(engine() % world.triangleCount());
    const float r = std::sqrt(u(engine)), v = u(engine) * r;
    const Surface s = surfaceOn(world, world.record(triangle).object, triangle, 1 - r, v, true);
    Vec3 d = tests::randomDirection(engine);
    if (glm::dot(d, s.ng) < 0) d = -d;
    Hit hit;
    hits.met += world.intersect(s.leave(d), hit, counters) &&
                world.record(hit.triangle).object == world.record(triangle).object;
    hits.missed += glm::dot(d, s.ng) > 0.01f && !world.intersect(s.leave(-d), hit, counters);
  }
  return hits;
}

TEST(Offset, Hard3NoSelfShadowNearAndFar) {
  HardCase shadowed = HardCase::counting("self-shadow to 10 km from the origin", "rays");
  HardCase passed = HardCase::counting("rays through the own surface to 10 km from the origin", "rays");
  for (const float distance : kDistances) {
    const SelfHits hits = selfHits(Vec3(distance, -distance, distance), 1);
    EXPECT_TRUE(shadowed.within(hits.met, 0)) << distance;
    EXPECT_TRUE(passed.within(hits.missed, 0)) << distance;
  }
}

TEST(Offset, Hard3NoSelfShadowAtAnyScale) {
  HardCase shadowed = HardCase::counting("self-shadow at scales 2^-20 to 2^20", "rays");
  HardCase passed = HardCase::counting("rays through the own surface at scales 2^-20 to 2^20", "rays");
  for (const int e : kExponents) {
    const SelfHits hits = selfHits(std::ldexp(1.0f, e) * Vec3(1, 2, 3), std::ldexp(1.0f, e));
    EXPECT_TRUE(shadowed.within(hits.met, 0)) << e;
    EXPECT_TRUE(passed.within(hits.missed, 0)) << e;
  }
}

/// Shadow rays from the lit face of a wall towards lights behind it that are not blocked.
int leaksOfWall(const Vec3& at, float scale, float thickness) {
  SceneMaker m;
  const int material = m.material(tests::diffuseMaterial(Vec3(1)));
  m.box(material, 0, at + scale * Vec3(-1, -1, 0), at + scale * Vec3(1, 1, thickness));
  const World world(m.scene, planOf());
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> u(-0.9f, 0.9f);
  RayCounters counters;
  int leaks = 0;
  for (int i = 0; i < 10000; ++i) {
    Hit hit;
    const Ray in{at + scale * Vec3(u(engine), u(engine), 1), {0, 0, -1}, 0, core::kInfinity};
    if (!world.intersect(in, hit, counters)) {
      ++leaks;
      continue;
    }
    const Surface s = makeSurface(world, hit, in.direction);
    Vec3 d = tests::randomDirection(engine);
    d.z = -std::fabs(d.z) - 0.01f;
    leaks += world.transmittance(s.leave(glm::normalize(d)), counters) != 0;
  }
  return leaks;
}

TEST(Offset, Hard3AThinWallDoesNotLeak) {
  // 5 cm even at 10 km, where a float's step is 1 mm.
  HardCase leaked = HardCase::counting("leaks of a wall of 5 cm to 10 km from the origin", "rays");
  for (const float distance : kDistances)
    EXPECT_TRUE(leaked.within(leaksOfWall(Vec3(distance), 1, 0.05f), 0));
  HardCase scaled =
      HardCase::counting("leaks of a wall of a thousandth of its width at scales 2^-20 to 2^20", "rays");
  for (const int e : kExponents)
    EXPECT_TRUE(scaled.within(leaksOfWall(Vec3(0), std::ldexp(1.0f, e), 2e-3f), 0)) << e;
}

TEST(Offset, Hard3HitsScaleExactlyWithPowersOfTwo) {
  const auto trace = [](int exponent) {
    SceneMaker m;
    const float scale = std::ldexp(1.0f, exponent);
    m.sphere(m.material(tests::diffuseMaterial(Vec3(1))), 0, scale * Vec3(0.3f, 0.1f, 0), scale, 16);
    m.box(0, 0, scale * Vec3(-3), scale * Vec3(3), true);
    const World world(m.scene, planOf());
    std::mt19937 engine(4);
    RayCounters counters;
    std::vector<float> values;
    for (int i = 0; i < 5000; ++i) {
      Hit hit;
      const Ray ray{scale * Vec3(0, 0, 2.5f), tests::randomDirection(engine), 0, core::kInfinity};
      if (!world.intersect(ray, hit, counters)) continue;
      const Surface s = makeSurface(world, hit, ray.direction);
      values.insert(values.end(), {hit.t / scale, hit.u, hit.v, s.ns.x, static_cast<float>(hit.triangle)});
      if (world.intersect(s.leave(s.ns), hit, counters)) values.push_back(hit.t / scale);
    }
    return values;
  };
  const std::vector<float> one = trace(0);
  ASSERT_GT(one.size(), 20000u);
  HardCase changed = HardCase::counting("hits that differ at scales 2^-20 to 2^20", "numbers");
  for (const int e : kExponents) {
    const std::vector<float> other = trace(e);
    ASSERT_EQ(other.size(), one.size());
    int differing = 0;
    for (std::size_t i = 0; i < one.size(); ++i) differing += other[i] != one[i];
    EXPECT_TRUE(changed.within(differing, 0)) << e;
  }
}

/// A room with a lamp, a mirror, a glass and a glossy ball, all lengths times 2^exponent; radiance has no
/// length.
core::ImageRgb pictureAtScale(int exponent) {
  const float scale = std::ldexp(1.0f, exponent);
  SceneMaker m;
  m.box(m.material(tests::diffuseMaterial({0.6f, 0.5f, 0.4f})), 0, scale * Vec3(-3), scale * Vec3(3), true);
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(10))), 0, scale * Vec3(-1, 2.9f, -1),
         scale * Vec3(2, 0, 0), scale * Vec3(0, 0, 2));
  m.sphere(m.material(tests::glassMaterial(1.5f, 0)), 1, scale * Vec3(-1, 0, 0), scale * 0.8f, 16);
  m.sphere(m.material(tests::metalMaterial(Vec3(0.8f), 0.3f)), 2, scale * Vec3(1, 0, 0), scale * 0.8f, 16);
  m.sphere(m.material(tests::metalMaterial(Vec3(0.9f), 0)), 3, scale * Vec3(0, -1.5f, 0.5f), scale * 0.5f,
           16);
  const World world(m.scene, planOf());
  core::Camera camera;
  camera.eye = scale * Vec3(0, 0, 2.9f);
  camera.at = Vec3(0);
  PathOptions options;
  options.samplesPerPixel = 4;
  options.bounces = 6;
  options.threads = 2;
  return tracePaths(world, core::View(camera, 64, 48, m.scene.bounds), options, {}).radiance;
}

TEST(Offset, Hard3ThePictureIsTheSameAtAnyScale) {
  const core::ImageRgb one = pictureAtScale(0);
  HardCase changed = HardCase::counting("pixels that differ at scales 2^-20 to 2^20", "pixels");
  for (const int e : kExponents) {
    const core::ImageRgb other = pictureAtScale(e);
    int differing = 0;
    for (std::size_t i = 0; i < one.pixels().size(); ++i) differing += one.pixels()[i] != other.pixels()[i];
    EXPECT_TRUE(changed.within(differing, 0)) << e;
  }
}

}  // namespace
}  // namespace saccade::raytrace
