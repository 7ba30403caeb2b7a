// Beer-Lambert inside solids: the law's own edges, and paths through slabs, balls and what is in them.
#include "raytrace/medium.h"

#include <gtest/gtest.h>

#include "core/scene/plan.h"
#include "raytrace/corrective_tracer.h"
#include "raytrace/path_tracer.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;
using tests::SceneMaker;

core::Material tinted(float ior, const Vec3& color, float distance) {
  core::Material m = tests::glassMaterial(ior, 0);
  m.attenuationColor = color;
  m.attenuationDistance = distance;
  return m;
}

core::Plan planFor(const core::Scene& scene) {
  core::Plan plan = core::makePlan(scene);
  plan.recursionDepth = 12;
  return plan;
}

/// Radiance along +x or another direction from a point, by paths.
Vec3 seen(const core::Scene& scene, const Vec3& eye, const Vec3& direction, int samples = 1) {
  const World world(scene, planFor(scene));
  PathOptions options;
  options.samplesPerPixel = samples;
  options.bounces = 64;
  RayCounters counters;
  return pathRadiance(world, {eye, glm::normalize(direction), 0, core::kInfinity}, options, counters);
}

/// Enough that roulette, which begins after three crossings, costs less than 1 %.
constexpr int kMany = 20000;

/// A lamp of radiance 1 in all channels, far away at x = 10, and black around.
SceneMaker lampAhead() {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, {10, -50, -50}, {0, 0, 100}, {0, 100, 0});
  return m;
}

const Vec3 kColor(0.25f, 0.5f, 1);

TEST(BeerLambert, Hard18IsTheColourToThePowerOfTheDistance) {
  HardCase off("transmittance against the colour to the power of the distance");
  const Vec3 sigma = absorption(tinted(1.5f, kColor, 2));
  for (float d : {0.5f, 2.0f, 6.0f, 40.0f}) {
    const Vec3 left = beerLambert(sigma, d);
    EXPECT_TRUE(off.near(left.x, std::pow(0.25, d / 2.0), 1e-6)) << d;
    EXPECT_TRUE(off.near(left.y, std::pow(0.5, d / 2.0), 1e-6)) << d;
    EXPECT_TRUE(off.near(left.z, 1, 0)) << d;
  }
}

TEST(BeerLambert, Hard18Edges) {
  const Vec3 one(1), none(0);
  HardCase thin("optical depth 0 and 1e-20 leave 1"), thick("optical depths above 103 leave 0"),
      product("0 times infinity: nothing is absorbed, and no NaN");
  const auto off = [](const Vec3& sigma, float distance, const Vec3& truth) {
    const Vec3 d = glm::abs(beerLambert(sigma, distance) - truth);
    return static_cast<double>(d.x + d.y + d.z);
  };
  EXPECT_TRUE(thin.within(off(one, 0, one), 0));
  EXPECT_TRUE(thin.within(off(Vec3(1e-20f), 1, one), 0));
  EXPECT_TRUE(thin.within(off(one, 1e-20f, one), 0));
  // exp(-104) is below the smallest float, exp(-103.2) the last that rounds up to it.
  EXPECT_TRUE(thick.within(off(one, 103.2f, none), std::numeric_limits<float>::denorm_min() * 3));
  EXPECT_TRUE(thick.within(off(one, 104, none), 0));
  EXPECT_TRUE(thick.within(off(Vec3(1e30f), 1e30f, none), 0));
  EXPECT_TRUE(thick.within(off(one, core::kInfinity, none), 0));
  EXPECT_TRUE(thick.within(off(Vec3(core::kInfinity), 1e-30f, none), 0));
  EXPECT_TRUE(product.within(off(none, core::kInfinity, one), 0));
  EXPECT_TRUE(product.within(off(Vec3(core::kInfinity), 0, one), 0));
}

TEST(BeerLambert, AbsorptionOfExtremeMaterials) {
  EXPECT_EQ(absorption(tinted(1.5f, Vec3(1), 1)), Vec3(0));
  EXPECT_EQ(absorption(tinted(1.5f, Vec3(0.5f), core::kInfinity)), Vec3(0));
  EXPECT_EQ(absorption(tinted(1.5f, Vec3(0), 1)), Vec3(core::kInfinity));
  core::Material wall = tinted(1.5f, Vec3(0.5f), 1);
  wall.thinWalled = true;
  EXPECT_EQ(absorption(wall), Vec3(0));
}

TEST(Medium, StraightThroughASlab) {
  // Index 1: no reflection, the ray goes straight on.
  SceneMaker m = lampAhead();
  m.box(m.material(tinted(1, kColor, 2)), 1, {0, -1, -1}, {3, 1, 1});
  const Vec3 l = seen(m.scene, {-5, 0.1f, 0.2f}, {1, 0, 0});
  EXPECT_NEAR(l.x, std::pow(0.25, 1.5), 1e-5);
  EXPECT_NEAR(l.y, std::pow(0.5, 1.5), 1e-5);
  EXPECT_EQ(l.z, 1);
  const Vec3 slanted = seen(m.scene, {-1, -0.5f, 0.2f}, {1, 0.2f, 0});
  EXPECT_NEAR(slanted.y, std::pow(0.5, 1.5 * std::sqrt(1.04)), 1e-5);
}

TEST(Medium, SlabOfGlassWithAllItsInnerReflections) {
  // T = (1 - R)^2 t / (1 - R^2 t^2) at normal incidence, R = 0.04; what is reflected meets black.
  SceneMaker m = lampAhead();
  m.box(m.material(tinted(1.5f, kColor, 2)), 1, {0, -40, -40}, {1, 40, 40});
  const Vec3 l = seen(m.scene, {-5, 0.1f, 0.2f}, {1, 0, 0}, 200000);
  for (int c = 0; c < 3; ++c) {
    const double t = std::pow(static_cast<double>(kColor[c]), 0.5);
    EXPECT_NEAR(l[c], 0.96 * 0.96 * t / (1 - 0.0016 * t * t), 3e-3 * t) << c;
  }
}

TEST(Medium, Hard18BallByItsChords) {
  HardCase off("paths through a tinted ball against its chords");
  SceneMaker m = lampAhead();
  m.sphere(m.material(tinted(1, kColor, 1)), 1, Vec3(0), 1, 128);
  for (float b : {0.0f, 0.4f, 0.8f}) {
    const Vec3 l = seen(m.scene, {-5, b, 0.01f}, {1, 0, 0});
    EXPECT_TRUE(off.near(l.y, std::pow(0.5, 2 * std::sqrt(1 - b * b)), 2e-3)) << b;
  }
}

TEST(Medium, ThinWallsDoNotTint) {
  SceneMaker m = lampAhead();
  core::Material wall = tinted(1, kColor, 2);
  wall.thinWalled = true;
  m.box(m.material(wall), 1, {0, -1, -1}, {3, 1, 1});
  m.box(m.material(tinted(1, kColor, 2)), 2, {5, -1, -1}, {7, 1, 1});  // tints: paths keep track
  EXPECT_NEAR(seen(m.scene, {-5, 0.1f, 0.2f}, {1, 0, 0}, kMany).y, 0.5, 5e-3);
}

TEST(Medium, ThinWallsBendNothingThoughClosed) {
  SceneMaker m = lampAhead();
  core::Material wall = tests::glassMaterial(1.5f, 0);
  wall.thinWalled = true;
  m.sphere(m.material(wall), 1, Vec3(0), 1, 16);
  const World world(m.scene, planFor(m.scene));
  EXPECT_FALSE(world.closed(1));
}

TEST(Medium, NestedSolidsTakeTurns) {
  // Outer 0 to 3, inner 1 to 2: the inner one replaces the outer.
  SceneMaker m = lampAhead();
  m.box(m.material(tinted(1, Vec3(1, 1, 0.5f), 1)), 1, {0, -2, -2}, {3, 2, 2});
  m.box(m.material(tinted(1, Vec3(1, 1, 0.1f), 1)), 2, {1, -1, -1}, {2, 1, 1});
  EXPECT_NEAR(seen(m.scene, {-5, 0.1f, 0.2f}, {1, 0, 0}, kMany).z, 0.25 * 0.1, 2.5e-4);
  // A clear bubble, too.
  SceneMaker bubble = lampAhead();
  bubble.box(bubble.material(tinted(1, Vec3(0.5f), 1)), 1, {0, -2, -2}, {3, 2, 2});
  bubble.box(bubble.material(tests::glassMaterial(1, 0)), 2, {1, -1, -1}, {2, 1, 1});
  EXPECT_NEAR(seen(bubble.scene, {-5, 0.1f, 0.2f}, {1, 0, 0}, kMany).x, 0.25, 2.5e-3);
}

TEST(Medium, WhatIsEmbeddedIsTinted) {
  SceneMaker m;
  m.box(m.material(tinted(1, kColor, 1)), 1, Vec3(-2), Vec3(2));
  m.box(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, Vec3(-1), Vec3(1));
  EXPECT_NEAR(seen(m.scene, {-5, 0.1f, 0.2f}, {1, 0, 0}).y, 0.5, 1e-5);
}

TEST(Medium, LampInsideGlassLightsThroughIt) {
  // A lamp at distance 1 over a small white plate, both inside: what light sampling and scattering find is
  // tinted by the way from the lamp, and by the way out.
  const auto plate = [](const core::Material& glass) {
    SceneMaker m;
    m.box(m.material(glass), 1, Vec3(-2), Vec3(2));
    m.quad(m.material(tests::diffuseMaterial(Vec3(0.8f))), 0, {-0.05f, -1, -0.05f}, {0, 0, 0.1f},
           {0.1f, 0, 0});
    m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, {-0.05f, 0, -0.05f}, {0.1f, 0, 0},
           {0, 0, 0.1f});
    return seen(m.scene, {4, 3, 0}, {-1, -1, 0}, 4000);
  };
  const Vec3 clear = plate(tests::glassMaterial(1, 0)), amber = plate(tinted(1, Vec3(0.5f), 1));
  EXPECT_NEAR(amber.x / clear.x, std::pow(0.5, 1 + 2 * std::sqrt(2)), 1e-3);
}

TEST(Medium, Hard27CameraInsideGlassSeesOutThroughIt) {
  HardCase off("paths from inside glass: what is left of the light");
  SceneMaker m = lampAhead();
  m.box(m.material(tinted(1, kColor, 1)), 1, Vec3(-2), Vec3(2));
  EXPECT_TRUE(off.near(seen(m.scene, {0, 0.1f, 0.2f}, {1, 0, 0}).y, 0.25, 1e-5));
  // On the surface, looking out: no glass in the way.
  EXPECT_TRUE(off.near(seen(m.scene, {2, 0.1f, 0.2f}, {1, 0, 0}).y, 1, 1e-5));
}

TEST(Medium, StateFollowsReflectionAndRefraction) {
  SceneMaker m;
  m.box(m.material(tinted(1.5f, kColor, 1)), 1, Vec3(-1), Vec3(1));
  const World world(m.scene, planFor(m.scene));
  Hit hit;
  RayCounters counters;
  ASSERT_TRUE(world.intersect({Vec3(-5, 0.1f, 0.2f), Vec3(1, 0, 0), 0, core::kInfinity}, hit, counters));
  const Surface in = makeSurface(world, hit, Vec3(1, 0, 0));
  Inside inside;
  inside.leave(in, Vec3(-1, 0, 0));  // reflected outside
  EXPECT_EQ(inside.transmittance(world, 1), Vec3(1));
  inside.leave(in, Vec3(1, 0, 0));
  EXPECT_NEAR(inside.transmittance(world, 1).y, 0.5, 1e-6);
  ASSERT_TRUE(world.intersect({Vec3(0, 0.1f, 0.2f), Vec3(1, 0, 0), 0, core::kInfinity}, hit, counters));
  const Surface out = makeSurface(world, hit, Vec3(1, 0, 0));
  inside.leave(out, Vec3(-1, 0, 0));  // total reflection
  EXPECT_NEAR(inside.transmittance(world, 1).y, 0.5, 1e-6);
  inside.leave(out, Vec3(1, 0, 0));
  EXPECT_EQ(inside.transmittance(world, 1), Vec3(1));
}

}  // namespace
}  // namespace saccade::raytrace
