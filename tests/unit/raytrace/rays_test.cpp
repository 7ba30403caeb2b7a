// Numerics 1-3, 5, 6 of the hard cases: the guard, self-intersection, leaks, scales, duplicates.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::planOf;
using tests::SceneMaker;

TEST(Guard, RandomBitPatternsNeverAbort) {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial(Vec3(1), 0)), 1, Vec3(0), 1);
  const World world(m.scene, planOf());
  std::mt19937 engine(1);
  const auto bits = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(engine())); };
  RayCounters counters;
  Hit hit;
  for (int i = 0; i < 1'000'000; ++i) {
    const Ray ray{{bits(), bits(), bits()}, {bits(), bits(), bits()}, bits(), bits()};
    const bool allowed = traceable(ray);
    ASSERT_FALSE(world.intersect(ray, hit, counters) && !allowed);
    world.transmittance(ray, counters);
    if (i % 16 == 0) world.intersectVisible(0, ray, hit, counters);
    if (i % 16 == 1) world.closestPoint(0, ray.origin, hit);
  }
  EXPECT_GT(counters.refused, 1'000'000u);
  EXPECT_GT(counters.rays, 1000u);
}

TEST(Guard, RefusesWhatHasNoMeaning) {
  const float nan = std::nanf(""), infinity = core::kInfinity;
  EXPECT_TRUE(traceable({Vec3(0), Vec3(0, 0, 1), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(1e-39f, 0, 0), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(nan, 0, 0), Vec3(0, 0, 1), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0, nan, 1), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(2e18f, 0, 0), Vec3(0, 0, 1), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0, 0, infinity), 0, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0, 0, 1), -1, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0, 0, 1), nan, infinity}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0, 0, 1), 0, nan}));
  EXPECT_FALSE(traceable({Vec3(0), Vec3(0, 0, 1), 2, 1}));
}

/// Rays that leave the convex body outwards must meet nothing; inwards must meet it.
void expectNoSelfHit(const Vec3& center, float radius) {
  SceneMaker m;
  const int material = m.material(tests::diffuseMaterial(Vec3(1)));
  m.sphere(material, 0, center, radius);
  m.box(material, 0, center + Vec3(3 * radius), center + Vec3(4 * radius));
  const World world(m.scene, planOf());
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(0, 1);
  RayCounters counters;
  int selfHits = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto triangle = static_cast<std::uint32_t>(engine() % world.triangleCount());
    const float r = std::sqrt(u(engine)), v = u(engine) * r;
    const Surface s = surfaceOn(world, world.record(triangle).object, triangle, 1 - r, v, true);
    Vec3 d = tests::randomDirection(engine);
    if (glm::dot(d, s.ng) < 0) d = -d;
    Hit hit;
    if (world.intersect(s.leave(d), hit, counters) &&
        world.record(hit.triangle).object == world.record(triangle).object) {
      ++selfHits;
    }
    if (glm::dot(d, s.ng) > 0.01f && !world.intersect(s.leave(-d), hit, counters)) ++missed;
  }
  EXPECT_EQ(selfHits, 0) << "center " << center.x << " radius " << radius;
  EXPECT_EQ(missed, 0) << "center " << center.x << " radius " << radius;
}

TEST(Offset, NoSelfShadowNearAndFar) {
  for (float distance : {0.0f, 1.0f, 100.0f, 10000.0f})
    expectNoSelfHit(Vec3(distance, -distance, distance), 1);
}

TEST(Offset, NoSelfShadowAtAnyScale) {
  for (int e : {-20, -10, 10, 20}) expectNoSelfHit(std::ldexp(1.0f, e) * Vec3(1, 2, 3), std::ldexp(1.0f, e));
}

TEST(Offset, AThinWallDoesNotLeak) {
  // 5 cm even at 10 km, where a float's step is 1 mm.
  for (float distance : {0.0f, 100.0f, 10000.0f}) {
    SceneMaker m;
    const int material = m.material(tests::diffuseMaterial(Vec3(1)));
    const Vec3 at(distance);
    m.box(material, 0, at + Vec3(-1, -1, 0), at + Vec3(1, 1, 0.05f));
    const World world(m.scene, planOf());
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> u(-0.9f, 0.9f);
    RayCounters counters;
    for (int i = 0; i < 10000; ++i) {
      Hit hit;
      const Ray in{at + Vec3(u(engine), u(engine), 1), {0, 0, -1}, 0, core::kInfinity};
      ASSERT_TRUE(world.intersect(in, hit, counters));
      const Surface s = makeSurface(world, hit, in.direction);
      // From the lit face towards a light behind the wall: blocked by the wall itself.
      Vec3 d = tests::randomDirection(engine);
      d.z = -std::fabs(d.z) - 0.01f;
      ASSERT_EQ(world.transmittance(s.leave(glm::normalize(d)), counters), 0);
    }
  }
}

TEST(Offset, ScalesExactlyWithPowersOfTwo) {
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
  EXPECT_EQ(one, trace(20));
  EXPECT_EQ(one, trace(-20));
}

TEST(World, UnsoundTrianglesAreMisses) {
  SceneMaker m;
  const int material = m.material(tests::diffuseMaterial(Vec3(1)));
  const float nan = std::nanf("");
  m.mesh(material, 1, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2});            // no area
  m.mesh(material, 2, {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});          // not a number
  m.mesh(material, 3, {{0, 0, 0}, {1e6f, 1e-6f, 0}, {2e6f, 0, 0}}, {0, 1, 2});  // a needle
  m.quad(material, 4, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  const World world(m.scene, planOf());
  RayCounters counters;
  Hit hit;
  ASSERT_TRUE(world.intersect({{0, 0, 1}, {0.01f, 0.02f, -1}, 0, core::kInfinity}, hit, counters));
  EXPECT_EQ(world.record(hit.triangle).object, 3u);
  EXPECT_FALSE(world.intersectVisible(0, {{0.5f, 0, 1}, {0, 0, -1}, 0, core::kInfinity}, hit, counters));
  EXPECT_FALSE(world.closestPoint(1, Vec3(0), hit));
}

TEST(World, CoplanarDuplicatesGoToTheFirst) {
  for (bool sphereFirst : {false, true}) {
    SceneMaker m;
    const int material = m.material(tests::diffuseMaterial(Vec3(1)));
    if (sphereFirst) m.sphere(material, 1, {5, 5, 5}, 1, 16);
    const auto first = static_cast<std::uint32_t>(m.scene.objects.size());
    m.quad(material, 2, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    m.quad(material, 3, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    const World world(m.scene, planOf());
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> u(-0.99f, 0.99f);
    RayCounters counters;
    for (int i = 0; i < 1000; ++i) {
      Hit hit;
      const Ray ray{{u(engine), u(engine), 1}, {0, 0, -1}, 0, core::kInfinity};
      ASSERT_TRUE(world.intersect(ray, hit, counters));
      ASSERT_EQ(world.record(hit.triangle).object, first);
      // The stencil may still name the second: its own tree has it.
      ASSERT_TRUE(world.intersectVisible(first + 1, ray, hit, counters));
      ASSERT_EQ(world.record(hit.triangle).object, first + 1);
    }
  }
}

TEST(World, ClosestPointIsTheNearestOnTheSphere) {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial(Vec3(1), 0)), 1, Vec3(1, 2, 3), 2, 64);
  const World world(m.scene, planOf());
  std::mt19937 engine(6);
  for (int i = 0; i < 200; ++i) {
    const Vec3 d = tests::randomDirection(engine);
    Hit hit;
    ASSERT_TRUE(world.closestPoint(0, Vec3(1, 2, 3) + 2.5f * d, hit));
    const Surface s = makeSurface(world, hit, -d);
    EXPECT_LT(glm::length(s.position - (Vec3(1, 2, 3) + 2.0f * d)), 0.06f);
    EXPECT_TRUE(s.front);
  }
}

TEST(World, MaskedTexelsLetLightThroughAndBlendedOnesPartly) {
  SceneMaker m;
  core::Texture t;
  t.image = core::ImageRgba8(2, 1);
  t.image.at(0, 0) = {255, 255, 255, 0};
  t.image.at(1, 0) = {255, 255, 255, 255};
  t.nearest = true;
  m.scene.textures.push_back(t);
  core::Material masked = tests::diffuseMaterial(Vec3(1));
  masked.alphaMode = core::AlphaMode::mask;
  masked.baseColorTexture.texture = 0;
  core::Material blended = tests::diffuseMaterial(Vec3(1));
  blended.alphaMode = core::AlphaMode::blend;
  blended.alpha = 0.25f;
  // uv0 = (x, z): the half x < 0.5 is cut out.
  m.quad(m.material(masked), 1, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  m.quad(m.material(blended), 0, {0, 0, -1}, {1, 0, 0}, {0, 1, 0});
  m.quad(1, 0, {0, 0, -2}, {1, 0, 0}, {0, 1, 0});
  const World world(m.scene, planOf());
  RayCounters counters;
  Hit hit;
  const Ray holed{{0.25f, 0.5f, 1}, {0, 0, -1}, 0, core::kInfinity};
  const Ray solid{{0.75f, 0.5f, 1}, {0, 0, -1}, 0, core::kInfinity};
  ASSERT_TRUE(world.intersect(holed, hit, counters));
  EXPECT_EQ(world.record(hit.triangle).object, 1u);
  ASSERT_TRUE(world.intersect(solid, hit, counters));
  EXPECT_EQ(world.record(hit.triangle).object, 0u);
  EXPECT_FALSE(world.intersectVisible(0, holed, hit, counters));
  EXPECT_FLOAT_EQ(world.transmittance(holed, counters), 0.75f * 0.75f);
  EXPECT_EQ(world.transmittance(solid, counters), 0);
}

TEST(World, BackFacesOfSingleSidedSurfacesAreNotThereForTheEye) {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {-1, -1, 0}, {0, 2, 0}, {2, 0, 0});  // front is -z
  m.quad(0, 0, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  const World world(m.scene, planOf());
  RayCounters counters;
  Hit hit;
  const Ray ray{{0.1f, 0.2f, 1}, {0, 0, -1}, 0, core::kInfinity};
  ASSERT_TRUE(world.intersect(ray, hit, counters));
  EXPECT_EQ(world.record(hit.triangle).object, 0u);
  ASSERT_TRUE(world.intersectVisible(ray, hit, counters));
  EXPECT_EQ(world.record(hit.triangle).object, 1u);
}

}  // namespace
}  // namespace saccade::raytrace
