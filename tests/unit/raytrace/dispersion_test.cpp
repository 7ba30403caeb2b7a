// Indices by channel: KHR_materials_dispersion.
#include <gtest/gtest.h>

#include "core/scene/plan.h"
#include "raytrace/medium.h"
#include "raytrace/path_tracer.h"
#include "tests/unit/raytrace/bsdf_patch.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::SceneMaker;

core::Plan planFor(const core::Scene& scene) {
  core::Plan plan = core::makePlan(scene);
  plan.recursionDepth = 12;
  return plan;
}

Vec3 seen(const core::Scene& scene, const Vec3& eye, const Vec3& direction, int samples) {
  const World world(scene, planFor(scene));
  PathOptions options;
  options.samplesPerPixel = samples;
  options.bounces = 64;
  RayCounters counters;
  return pathRadiance(world, {eye, glm::normalize(direction), 0, core::kInfinity}, options, counters);
}

core::Material prism(float dispersion) {
  core::Material m = tests::glassMaterial(1.5f, 0);
  m.dispersion = dispersion;
  return m;
}

TEST(Dispersion, IndicesSpreadByTheAbbeNumber) {
  // n_F - n_C = (n_d - 1) / V, V = 20 / dispersion.
  for (float dispersion : {0.3f, 1.0f, 5.0f}) {
    EXPECT_NEAR(dispersedIor(1.5f, dispersion, 2) - dispersedIor(1.5f, dispersion, 0), 0.5f * dispersion / 20,
                1e-6);
    EXPECT_EQ(dispersedIor(1.5f, dispersion, 1), 1.5f);
  }
  for (int c = 0; c < 3; ++c) EXPECT_EQ(dispersedIor(1.5f, 0, c), 1.5f);
  EXPECT_EQ(dispersedIor(1.5f, 1000, 0), 1);
}

TEST(Dispersion, HeroesAddUpToTheColour) {
  const Vec3 c(0.2f, 0.5f, 0.9f);
  EXPECT_LT(glm::length((heroOf(c, 0) + heroOf(c, 1) + heroOf(c, 2)) / 3.0f - c), 1e-6f);
}

TEST(Dispersion, EachChannelBendsByItsOwnIndex) {
  tests::Patch s = tests::patch(0, 0, 1, true);
  s.material.dispersion = 5;
  tests::bind(s);
  for (int channel = 0; channel < 3; ++channel) {
    Bsdf bsdf = s.at(0.6f);
    bsdf.setIor(s.surface.iorOf(channel));
    const auto through = bsdf.deltaTransmission();
    ASSERT_TRUE(through);
    const float sine = std::sqrt(1 - through->direction.z * through->direction.z);
    EXPECT_NEAR(sine, 0.8f / dispersedIor(1.5f, 5, channel), 1e-5);
  }
}

TEST(Dispersion, ASetIndexIsThatOfTheMaterialBitForBit) {
  for (bool front : {true, false}) {
    tests::Patch set = tests::patch(0.2f, 0.4f, 0.7f, true, 1.5f),
                 made = tests::patch(0.2f, 0.4f, 0.7f, true, 1.5f);
    set.surface.front = made.surface.front = front;
    made.surface.point.ior = 1.6f;
    tests::bind(set);
    tests::bind(made);
    Bsdf a = set.at(0.8f);
    a.setIor(1.6f);
    const Bsdf b = made.at(0.8f);
    for (float z : {0.9f, 0.3f, -0.4f, -0.9f}) {
      const Vec3 l = tests::Patch::direction(z, 2);
      EXPECT_EQ(a.eval(l, kLobeAll), b.eval(l, kLobeAll));
      EXPECT_EQ(a.pdf(l, kLobeAll), b.pdf(l, kLobeAll));
    }
  }
}

TEST(Dispersion, NoneIsPlainGlassBitForBit) {
  const auto ball = [](float dispersion) {
    SceneMaker m;
    m.box(m.material(tests::diffuseMaterial(Vec3(0.3f), Vec3(1, 2, 3))), 0, Vec3(-3), Vec3(3), true);
    m.sphere(m.material(prism(dispersion)), 1, Vec3(0), 1, 16);
    m.box(m.material(prism(0)), 2, {-2, -2, -2}, {-1.5f, -1.5f, -1.5f});
    return seen(m.scene, {-2.5f, 0.3f, 0.2f}, {1, -0.1f, 0}, 200);
  };
  EXPECT_EQ(ball(0), ball(-1));  // neither splits
  EXPECT_NE(ball(0), ball(1));
}

TEST(Dispersion, WhiteFurnaceStaysWhite) {
  // Radiance 1 from all around a ball of glass: whatever way each channel takes, it brings 1.
  SceneMaker m;
  m.box(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, Vec3(-3), Vec3(3), true);
  m.sphere(m.material(prism(5)), 1, Vec3(0), 1, 32);
  const Vec3 l = seen(m.scene, {-2, 0.5f, 0.2f}, {1, 0, 0}, 60000);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(l[c], 1, 4 * std::sqrt(2.0 / 60000) + 2e-3) << c;  // variance 3 - 1
}

TEST(Dispersion, ChannelsAreUnbiased) {
  // Each channel of the split picture is that of plain glass with its index.
  const auto ball = [](const core::Material& glass) {
    SceneMaker m;
    m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, {3, -0.2f, -2}, {0, 0, 4}, {0, 4, 0});
    m.sphere(m.material(glass), 1, Vec3(0), 1, 64);
    return seen(m.scene, {-4, 0.55f, 0}, {1, 0, 0}, 40000);
  };
  const Vec3 split = ball(prism(8));
  for (int c = 0; c < 3; ++c) {
    core::Material plain = prism(0);
    plain.ior = dispersedIor(1.5f, 8, c);
    const float truth = ball(plain)[c];
    EXPECT_NEAR(split[c], truth, 4 * std::sqrt(3 * std::max(truth, 0.01f) / 40000)) << c;
  }
}

TEST(Dispersion, PlanSaysWhichScenesSplit) {
  SceneMaker m;
  m.sphere(m.material(prism(1)), 1, Vec3(0), 1, 8);
  EXPECT_TRUE(core::makePlan(m.scene).dispersion);
  m.scene.materials[0].thinWalled = true;
  EXPECT_FALSE(core::makePlan(m.scene).dispersion);
  m.scene.materials[0].thinWalled = false;
  m.scene.objects[0].closed = false;
  EXPECT_FALSE(core::makePlan(m.scene).dispersion);
}

}  // namespace
}  // namespace saccade::raytrace
