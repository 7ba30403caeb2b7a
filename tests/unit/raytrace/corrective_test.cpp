// Corrective samples and the log of their rays.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "core/error.h"
#include "raytrace/corrective_tracer.h"
#include "raytrace/path_tracer.h"
#include "raytrace/ray_log.h"
#include "raytrace/reference.h"
#include "raytrace/surface.h"
#include "tests/unit/raytrace/corrective_scenes.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

TEST(CorrectiveTracer, AMirrorShowsTheLampTimesFresnel) {
  SceneMaker m;
  m.quad(m.material(tests::metalMaterial(Vec3(0.9f), 0)), 1, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(2, 3, 4))), 0, {2, 1, -1}, {0, 0, 2}, {0, 2, 0});
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({-2, 2, 0}, {0, 0, 0}), 33, 33);
  RayCounters counters;
  const core::Sample s = tracer.trace(*frame, 16, 16, 3, counters);
  const float f = 0.9f + 0.1f * std::pow(1 - std::sqrt(0.5f), 5.0f);
  EXPECT_NEAR(s.correction.x, 2 * f, 1e-4);
  EXPECT_NEAR(s.correction.z, 4 * f, 2e-4);
  EXPECT_LT(glm::length(s.position), 1e-4f);
  EXPECT_LT(glm::length(s.normal - Vec3(0, 1, 0)), 1e-5f);
  EXPECT_NEAR(s.cosView, std::sqrt(0.5f), 1e-4);
  EXPECT_NEAR(s.viewDepth, std::sqrt(8.0f), 1e-4);
  EXPECT_FALSE(s.fromDepth);
  EXPECT_EQ(s.id, 1u);
  EXPECT_EQ(s.level, 3);
  EXPECT_EQ(counters.rays, 2u);
}

TEST(CorrectiveTracer, BasePlusCorrectionIsTheTracedImageWhereTheMapsAreExact) {
  // In a shell of radiance 1 the irradiance on a convex body is pi: maps are exact, so base + correction must
  // be what the path tracer finds, for every kind of material.
  core::Material plastic = tests::diffuseMaterial(Vec3(0.5f));
  plastic.ior = 1.5f;
  plastic.roughness = 0.3f;
  core::Material mixed = plastic;
  mixed.metallic = 0.4f;
  mixed.transmission = 0.5f;
  core::Material lacquered = plastic;  // a smooth coat over a rough base
  lacquered.clearcoat = 1;
  core::Material velvet = plastic;
  velvet.sheenColor = Vec3(0.8f);
  velvet.sheenRoughness = 0.4f;
  velvet.clearcoat = 0.5f;
  velvet.clearcoatRoughness = 0.4f;
  core::Material pearl = lacquered;
  pearl.metallic = 0.5f;
  pearl.roughness = 0;
  pearl.iridescence = 1;
  pearl.anisotropy = 0.7f;
  core::Material coatedGlass = tests::glassMaterial(1.5f, 0.3f);
  coatedGlass.clearcoat = 1;
  coatedGlass.sheenColor = Vec3(0.3f);
  core::Material amber = tests::glassMaterial(1.5f, 0);
  amber.attenuationColor = Vec3(0.5f, 0.4f, 0.2f);
  amber.attenuationDistance = 1;
  core::Material crystal = tests::glassMaterial(1.5f, 0);
  crystal.dispersion = 5;
  core::Material ward = tests::diffuseMaterial(Vec3(0.4f));
  ward.ward = core::WardLobe{Vec3(0.4f), Vec3(0.4f), 0.2f, 0.1f};
  for (const core::Material& material :
       {plastic, mixed, tests::metalMaterial(Vec3(0.7f), 0.6f), tests::glassMaterial(1.5f, 0),
        tests::glassMaterial(1.5f, 0.4f), lacquered, velvet, pearl, coatedGlass, amber, crystal, ward}) {
    SceneMaker m;
    m.box(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, Vec3(-3), Vec3(3), true);
    m.sphere(m.material(material), 1, Vec3(0), 1, 32);
    core::Plan plan = core::makePlan(m.scene);
    plan.recursionDepth = 16;
    World world(m.scene, plan);
    const core::IlluminationMaps maps = constantMaps(kHalfPi);
    world.setMaps(&maps);
    CorrectiveOptions options;
    options.samplesPerPixel = 64;
    const CorrectiveTracer tracer(world, options);
    const auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 16, 16);
    const TraceAllResult all = traceAll(tracer, *frame, 0, {});
    PathOptions paths;
    paths.samplesPerPixel = 256;
    paths.bounces = 17;
    RayCounters counters;
    double corrected = 0, traced = 0;
    for (int y = 6; y < 10; ++y) {
      for (int x = 6; x < 10; ++x) {
        const Vec3 d = glm::normalize(frame->view.direction({x + 0.5f, y + 0.5f}));
        const Ray ray{frame->view.camera().eye, d, 0, core::kInfinity};
        Hit hit;
        ASSERT_TRUE(world.intersect(ray, hit, counters));
        const BaseLight base = baseLight(world, hit, d);
        corrected += base.reflected.x + base.emitted.x + all.corrections[frame->index(x, y)].x;
        traced += pathRadiance(world, ray, paths, counters).x;
      }
    }
    EXPECT_NEAR(corrected / traced, 1, 0.012)
        << "metallic " << material.metallic << " roughness " << material.roughness << " coat "
        << material.clearcoat << " sheen " << material.sheenColor.x << " dispersion " << material.dispersion
        << " Ward " << material.ward.has_value() << " attenuation " << material.attenuationColor.x;
  }
}

TEST(CorrectiveTracer, BlendIsCoverage) {
  SceneMaker m;
  core::Material veil = tests::diffuseMaterial(Vec3(0.5f), Vec3(4));
  veil.alphaMode = core::AlphaMode::blend;
  veil.alpha = 0.25f;
  m.quad(m.material(veil), 1, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1, 2, 3))), 0, {-3, -3, -1}, {6, 0, 0}, {0, 6, 0});
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({0, 0, 2}, Vec3(0)), 9, 9);
  RayCounters counters;
  const core::Sample s = tracer.trace(*frame, 4, 4, 7, counters);
  // The base holds 0.25 * 4; index 1 leaves no specular lobe, so what is missing is what lies behind.
  EXPECT_NEAR(s.correction.x, 0.75f, 1e-5);
  EXPECT_NEAR(s.correction.z, 2.25f, 1e-5);
}

TEST(CorrectiveTracer, WhereTheRayMissesThePointOfTheDepthBufferIsShaded) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 64, 64);
  // The rasteriser's silhouette of the metal sphere is a pixel wider than the rays'.
  int x = 32;
  while (frame->idAt(x, 32) != 2) ++x;
  const std::size_t edge = frame->index(x, 32), beyond = frame->index(x - 1, 32);
  frame->ids[beyond] = 2;
  frame->depth[beyond] = frame->depth[edge];
  RayCounters counters;
  const core::Sample s = tracer.trace(*frame, x - 1, 32, 7, counters);
  EXPECT_TRUE(s.fromDepth);
  EXPECT_NEAR(glm::length(s.position - Vec3(1, 0, 0)), 0.8f, 0.01f);
  EXPECT_GE(s.cosView, 0);
  EXPECT_GT(s.viewDepth, 0);
  EXPECT_EQ(counters.nonFinite, 0u);
  EXPECT_EQ(traceAll(tracer, *frame, 0, {}).fromDepth, 1u);
}

TEST(CorrectiveTracer, AnUnknownIdIsAnErrorAndInfiniteLightIsZeroAndCounted) {
  SceneMaker m;
  m.quad(m.material(tests::metalMaterial(Vec3(0.9f), 0)), 1, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(core::kInfinity))), 0, {2, 1, -1}, {0, 0, 2},
         {0, 2, 0});
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  auto frame = frameOf(world, cameraAt({-2, 2, 0}, {0, 0, 0}), 33, 33);
  RayCounters counters;
  EXPECT_EQ(tracer.trace(*frame, 16, 16, 7, counters).correction, Vec3(0));
  EXPECT_EQ(counters.nonFinite, 1u);
  frame->ids[frame->index(16, 16)] = 9;
  EXPECT_THROW(tracer.trace(*frame, 16, 16, 7, counters), core::Error);
}

TEST(CorrectiveTracer, PixelsTracedTogetherHaveTheBitsTheyHaveAlone) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 40, 40);
  std::vector<core::Pixel> pixels;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (frame->idAt(x, y) != 0) pixels.push_back({x, y});
    }
  }
  RayCounters together, alone;
  std::vector<core::Sample> samples;
  tracer.trace(*frame, pixels, 7, together, samples);
  ASSERT_EQ(samples.size(), pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const core::Sample s = tracer.trace(*frame, pixels[i].x, pixels[i].y, 7, alone);
    EXPECT_EQ(samples[i].x, pixels[i].x);
    EXPECT_EQ(samples[i].y, pixels[i].y);
    EXPECT_EQ(samples[i].correction, s.correction);
    EXPECT_EQ(samples[i].position, s.position);
    EXPECT_EQ(samples[i].normal, s.normal);
    EXPECT_EQ(samples[i].viewDepth, s.viewDepth);
  }
  EXPECT_EQ(together.rays, alone.rays);
  EXPECT_NE(pixels.size() % 16, 0u);  // the last group is not full
}

TEST(CorrectiveTracer, APointSeenAgainShowsWhatItsMirrorShowsThen) {
  // Lamps of radiance 2 and 5 in turn, 0.5 m wide each, stand behind the mirror's reflected rays.
  SceneMaker m;
  m.quad(m.material(tests::metalMaterial(Vec3(1), 0)), 1, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  for (int i = 0; i < 8; ++i) {
    const auto radiance = i % 2 ? 5.0f : 2.0f;
    m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(radiance))), 0,
           {2, 0.5f * static_cast<float>(i), -1}, {0, 0, 2}, {0, 0.5f, 0});
  }
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({-2, 2.25f, 0}, {0, 0, 0}), 33, 33);
  RayCounters counters;
  const core::Sample s = tracer.trace(*frame, 16, 16, 7, counters);
  EXPECT_NEAR(s.correction.x, 2, 1e-4);  // reflected to (2, 2.25): the fifth lamp
  EXPECT_LT(glm::length(s.toEye - glm::normalize(Vec3(-2, 2.25f, 0))), 1e-5f);
  for (const float height : {0.25f, 0.75f, 1.3f, 2.25f, 2.75f, 3.2f}) {
    const auto seen = tracer.revisit(s, {-2, height, 0}, counters);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->correction.x, static_cast<int>(2 * height) % 2 ? 5 : 2, 1e-4) << height;
    EXPECT_EQ(seen->shown, Vec3(0));
  }
  EXPECT_FALSE(tracer.revisit(s, {-2, -1, 0}, counters));  // from below
  EXPECT_FALSE(tracer.revisit(s, s.position, counters));
}

TEST(CorrectiveTracer, RepeatsASampleForTheEyeThatItWasTracedFor) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const Vec3 eye(0, 0, 2.9f);
  const auto frame = frameOf(world, cameraAt(eye, Vec3(0)), 40, 40);
  RayCounters counters;
  int samples = 0, found = 0, near = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (frame->idAt(x, y) == 0) continue;
      const core::Sample s = tracer.trace(*frame, x, y, 7, counters);
      if (s.fromDepth) continue;
      ++samples;
      const auto seen = tracer.revisit(s, eye, counters);
      found += seen.has_value();
      near += seen && glm::length(seen->correction - s.correction) <= 0.01f * (1 + glm::length(s.correction));
    }
  }
  // The ray to the point is not the pixel's bit for bit: edges of what is reflected may fall to either side.
  EXPECT_GT(samples, 100);
  EXPECT_GE(found, samples * 98 / 100);
  EXPECT_GE(near, samples * 95 / 100);
}

TEST(RayLog, HoldsEveryRayAndReplaysTheirHits) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 40, 40);
  RayLog log;
  RayCounters counters;
  counters.log = &log;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (frame->idAt(x, y) != 0) tracer.trace(*frame, x, y, 7, counters);
    }
  }
  EXPECT_EQ(log.entries().size(), counters.rays);
  std::uint64_t hits = 0;
  RayCounters again;
  for (const RayLog::Entry& e : log.entries()) {
    Hit hit;
    if (e.occluded) {
      hits += world.transmittance(e.ray, again) == 0;
    } else if (e.object >= 0) {
      hits += world.intersectVisible(static_cast<std::uint32_t>(e.object), e.ray, hit, again);
    } else {
      hits += world.intersect(e.ray, hit, again);
    }
  }
  EXPECT_EQ(replayRays(world, log), hits);
  EXPECT_GT(hits, 100u);
}

/// Red ahead (-Z), green behind, blue above.
std::shared_ptr<const core::Environment> colouredSky() {
  core::Environment e;
  e.radiance = core::ImageRgb(32, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x)
      e.radiance.at(x, y) = y < 4 ? Vec3(0, 0, 3) : x >= 8 && x < 24 ? Vec3(1, 0, 0) : Vec3(0, 2, 0);
  }
  return std::make_shared<const core::Environment>(std::move(e));
}

TEST(Corrective, ReflectionsAndRefractionsThatMissShowTheEnvironment) {
  SceneMaker m;
  m.quad(m.material(tests::metalMaterial(Vec3(1), 0)), 1, {-1, -0.3f, -2}, {1, 0, 0}, {0, 1.2f, 0});
  m.quad(m.material(tests::glassMaterial(1, 0)), 2, {0, -0.3f, -2}, {1, 0, 0}, {0, 1.2f, 0});
  core::Material veil = tests::diffuseMaterial(Vec3(0));
  veil.alphaMode = core::AlphaMode::blend;
  veil.alpha = 0.25f;
  m.quad(m.material(veil), 3, {-1, -1, -2}, {2, 0, 0}, {0, 0.6f, 0});
  m.scene.environment = colouredSky();
  const World world(m.scene, planOf());
  const auto frame = frameOf(world, cameraAt({0, 0, 0}, {0, 0, -1}), 32, 32);
  const CorrectiveTracer tracer(world, {});
  RayCounters counters;
  std::map<std::uint32_t, int> seen;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const std::uint32_t id = frame->idAt(x, y);
      if (id == 0) continue;
      const Vec3 c = tracer.trace(*frame, x, y, 7, counters).correction;
      const Vec3 truth = id == 1 ? Vec3(0, 2, 0) : Vec3(id == 3 ? 0.75f : 1.0f, 0, 0);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], truth[k], 1e-4) << id << " at " << x << ", " << y;
      ++seen[id];
    }
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(Corrective, RoughReflectionsOfTheEnvironmentAgreeWithPaths) {
  for (const float roughness : {0.15f, 0.4f, 0.9f}) {
    SceneMaker m;
    m.quad(m.material(tests::metalMaterial(Vec3(0.9f), roughness)), 1, {-1, -1, -2}, {2, 0, 0}, {0, 2, 0});
    m.scene.environment = colouredSky();
    const World world(m.scene, planOf());
    const auto frame = frameOf(world, cameraAt({0, 0, 0}, {0, 0, -1}), 9, 9);
    CorrectiveOptions options;
    options.samplesPerPixel = 20000;
    RayCounters counters;
    const Vec3 c = CorrectiveTracer(world, options).trace(*frame, 4, 4, 7, counters).correction;
    PathOptions paths;
    paths.samplesPerPixel = 40000;
    const Vec3 direction = frame->view.direction({4.5f, 4.5f});
    const Vec3 l =
        pathRadiance(world, {Vec3(0), glm::normalize(direction), 0, core::kInfinity}, paths, counters);
    EXPECT_GT(l.y, 0.5f);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], l[k], 0.015f) << roughness;
  }
}

}  // namespace
}  // namespace saccade::raytrace
