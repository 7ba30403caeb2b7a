// Numerics 1, 2, 5, 6 of the hard cases: the guard, unsound triangles, duplicates.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;
using tests::planOf;
using tests::SceneMaker;

TEST(Guard, Hard1RandomBitPatternsNeverAbort) {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial(Vec3(1), 0)), 1, Vec3(0), 1);
  const World world(m.scene, planOf());
  std::mt19937 engine(1);
  const auto bits = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(engine())); };
  RayCounters counters;
  Hit hit;
  int meaningless = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const Ray ray{{bits(), bits(), bits()}, {bits(), bits(), bits()}, bits(), bits()};
    const bool allowed = traceable(ray);
    meaningless += world.intersect(ray, hit, counters) && !allowed;
    world.transmittance(ray, counters);
    if (i % 16 == 0) world.intersectVisible(0, ray, hit, counters);
    if (i % 16 == 1) world.closestPoint(0, ray.origin, hit);
  }
  EXPECT_GT(counters.refused, 1'000'000u);
  EXPECT_GT(counters.rays, 1000u);
  HardCase hits =
      HardCase::counting("a million random bit patterns: none aborts, none refused is a hit", "rays");
  EXPECT_TRUE(hits.within(meaningless, 0));
}

TEST(Guard, Hard2ZeroAndSubnormalDirectionsAreMisses) {
  // From inside a sphere, where every ray that counts is a hit.
  SceneMaker m;
  m.sphere(m.material(tests::diffuseMaterial(Vec3(1))), 1, Vec3(0), 1);
  const World world(m.scene, planOf());
  std::mt19937 engine(7);
  RayCounters counters;
  Hit hit;
  int hits = 0;
  for (int i = 0; i < 100000; ++i) {
    // A subnormal has no exponent bit; one of a million is 0.
    const auto subnormal = [&] {
      return std::bit_cast<float>(static_cast<std::uint32_t>(engine()) & 0x807fffffu);
    };
    const Vec3 none = i < 8 ? Vec3(i & 1 ? -0.0f : 0.0f, i & 2 ? -0.0f : 0.0f, i & 4 ? -0.0f : 0.0f)
                            : Vec3(subnormal(), subnormal(), subnormal());
    hits += world.intersect({Vec3(0.1f), none, 0, core::kInfinity}, hit, counters);
    hits += world.transmittance({Vec3(0.1f), none, 0, core::kInfinity}, counters) != 1;
  }
  EXPECT_TRUE(HardCase::counting("zero and subnormal directions that hit", "rays").within(hits, 0));
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

TEST(World, Hard5UnsoundTrianglesAreMisses) {
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
  HardCase wrong = HardCase::counting(
      "needle, zero-area and NaN triangles: rays that do not meet what lies behind", "rays");
  std::mt19937 engine(8);
  std::uniform_real_distribution<float> u(-0.9f, 0.9f);
  int lost = 0;
  for (int i = 0; i < 10000; ++i) {
    // Aside of the needle, which is thinner than the step of a float there and may be met or not.
    const float y = u(engine);
    const Vec3 target(u(engine), std::fabs(y) > 0.01f ? y : 0.5f, -1);
    lost += !world.intersect({{0, 0, 1}, target - Vec3(0, 0, 1), 0, core::kInfinity}, hit, counters) ||
            world.record(hit.triangle).object != 3;
  }
  EXPECT_TRUE(wrong.within(lost, 0));
  EXPECT_FALSE(world.intersectVisible(0, {{0.5f, 0, 1}, {0, 0, -1}, 0, core::kInfinity}, hit, counters));
  EXPECT_FALSE(world.closestPoint(1, Vec3(0), hit));
}

/// Objects met by rays upon two equal quads, the stencil's own tree included, that are not what they should
/// be. `before`: what else is built first.
int wrongDuplicates(int before, int rays) {
  SceneMaker m;
  const int material = m.material(tests::diffuseMaterial(Vec3(1)));
  for (int i = 0; i < before; ++i) m.sphere(material, 1, {5.0f + 3 * i, 5, 5}, 1, 4 + 3 * i);
  const auto first = static_cast<std::uint32_t>(m.scene.objects.size());
  m.quad(material, 2, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  m.quad(material, 3, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  for (int i = before; i < 4; ++i) m.sphere(material, 4, {-5.0f - 3 * i, 5, 5}, 1, 8);
  const World world(m.scene, planOf());
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> u(-0.99f, 0.99f);
  RayCounters counters;
  int wrong = 0;
  for (int i = 0; i < rays; ++i) {
    Hit hit;
    const Ray ray{{u(engine), u(engine), 1}, {0, 0, -1}, 0, core::kInfinity};
    wrong += !world.intersect(ray, hit, counters) || world.record(hit.triangle).object != first;
    // The stencil may still name the second: its own tree has it.
    wrong += !world.intersectVisible(first + 1, ray, hit, counters) ||
             world.record(hit.triangle).object != first + 1;
  }
  return wrong;
}

TEST(World, Hard6CoplanarDuplicatesGoToTheFirst) {
  HardCase wrong =
      HardCase::counting("coplanar duplicates in five build orders: rays that meet another", "rays");
  for (int before = 0; before <= 4; ++before) EXPECT_TRUE(wrong.within(wrongDuplicates(before, 2000), 0));
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
