// Numerics 7 and 8 of the hard cases: light sampling against analytic truths.
#include "raytrace/lights.h"

#include <gtest/gtest.h>

#include <random>

#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/irradiance.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;
using tests::planOf;
using tests::SceneMaker;

core::Material lamp(float radiance) { return tests::diffuseMaterial(Vec3(0), Vec3(radiance)); }

TEST(Lights, Hard8DiskAboveAPoint) {
  SceneMaker m;
  constexpr int kCorners = 400;
  constexpr float kRadius = 0.7f, kHeight = 1.3f;
  std::vector<Vec3> p = {{0, kHeight, 0}};
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const float a = 2 * core::kPi * static_cast<float>(i) / kCorners;
    p.emplace_back(kRadius * std::cos(a), kHeight, kRadius * std::sin(a));
    indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % kCorners});  // faces down
  }
  m.mesh(m.material(lamp(5)), 0, p, indices);
  const World world(m.scene, planOf());
  const Estimate e = irradianceBySampling(world, Vec3(0), {0, 1, 0}, 1000000);
  const double exact = core::kPi * 5 * kRadius * kRadius / (kRadius * kRadius + kHeight * kHeight);
  // 4e-5: the polygon lacks so much of the disk.
  EXPECT_TRUE(HardCase("disk light, relative").near(e.mean / exact, 1, 4 * e.sigma / exact + 1e-4));
}

TEST(Lights, Hard8RectangleAlsoWhenTheHorizonCutsIt) {
  SceneMaker m;
  const Vec3 corner(-0.5f, 1, -0.3f), e1(1, 0, 0), e2(0, 0, 0.9f);
  m.quad(m.material(lamp(2)), 0, corner, e1, e2);  // cross(x, z) = -y: down
  const World world(m.scene, planOf());
  const Vec3 point(0.1f, 0, 0.2f);
  const auto check = [&](const Vec3& normal, HardCase& off) {
    const Estimate e = irradianceBySampling(world, point, normal, 400000);
    const double exact =
        2 * polygonIrradiance(point, normal, {corner, corner + e1, corner + e1 + e2, corner + e2});
    ASSERT_GT(exact, 0.01);
    EXPECT_TRUE(off.near(e.mean / exact, 1, 4 * e.sigma / exact + 1e-4)) << normal.x << " " << normal.y;
  };
  HardCase whole("rectangle light, relative"), cut("rectangle light cut by the horizon, relative");
  check(Vec3(0, 1, 0), whole);
  for (const Vec3& normal : {Vec3(1, 0.2f, 0), Vec3(1, -0.2f, 0.3f), Vec3(0, 0.1f, -1)})
    check(glm::normalize(normal), cut);
}

TEST(Lights, Hard8BehindAndGrazingGiveExactlyZero) {
  SceneMaker m;
  const int material = m.material(lamp(2));
  m.quad(material, 0, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});  // faces down, y = 1
  const World world(m.scene, planOf());
  HardCase behind("irradiance behind a light"), plane("irradiance in a light's plane"),
      below("irradiance of a light below the horizon");
  EXPECT_TRUE(behind.within(irradianceBySampling(world, {0, 2, 0}, {0, -1, 0}, 10000).mean, 0));
  EXPECT_TRUE(plane.within(irradianceBySampling(world, {3, 1, 0}, {-1, 0, 0}, 10000).mean, 0));
  EXPECT_TRUE(below.within(irradianceBySampling(world, {0, 0, 0}, {0, -1, 0}, 10000).mean, 0));
}

TEST(Lights, Hard7WithoutAreaGivesExactlyZero) {
  HardCase light("irradiance of lights without area"),
      kept = HardCase::counting("lights without area that are kept", "lights");
  const std::vector<std::vector<Vec3>> shapes = {{{0, 1, 0}, {1, 1, 0}, {2, 1, 0}},   // three in a row
                                                 {{0, 1, 0}, {0, 1, 0}, {1, 1, 1}},   // two equal
                                                 {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};  // a point
  for (const std::vector<Vec3>& shape : shapes) {
    SceneMaker flat;
    flat.mesh(flat.material(lamp(2)), 0, shape, {0, 1, 2});
    const World none(flat.scene, planOf());
    EXPECT_TRUE(kept.within(!none.lights().empty(), 0));
    EXPECT_TRUE(light.within(irradianceBySampling(none, Vec3(0), {0, 1, 0}, 100).mean, 0));
    // Beside a light that has area they take nothing from it.
    flat.quad(0, 0, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
    const World both(flat.scene, planOf());
    EXPECT_TRUE(kept.within(static_cast<double>(both.lights().emissiveCount()) - 2, 0));
  }
}

TEST(Lights, DensityIntegratesToTheSolidAngle) {
  // E[1 / pdf] over the samples = the solid angle of what shines at the point; and pdf() agrees with
  // sample().
  for (int extra : {0, 40}) {  // few groups: by estimate; many: by power
    SceneMaker m;
    const int material = m.material(lamp(2));
    m.quad(material, 0, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
    for (int i = 0; i < extra; ++i)
      m.quad(material, 0, {3.0f + i, 1, 0}, {0.1f, 0, 0}, {0, 0, 0.1f + 0.01f * i});
    const World world(m.scene, planOf());
    std::mt19937 engine(22);
    std::uniform_real_distribution<float> u(0, 1);
    RayCounters counters;
    const Vec3 point(0.2f, 0.3f, 0.1f);
    const LightChoice choice = world.lights().choose(point);
    double solidAngle = 0;
    int agreed = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      LightSample s;
      ASSERT_TRUE(world.lights().sample(choice, u(engine), {u(engine), u(engine)}, s));
      Hit hit;
      ASSERT_TRUE(world.intersect({point, s.direction, 0, core::kInfinity}, hit, counters));
      if (world.record(hit.triangle).object == 0) solidAngle += 1 / s.pdf / kSamples;
      const float p = world.lights().pdf(choice, hit.triangle, s.direction, hit.t);
      agreed += std::fabs(p - s.pdf) < 1e-2f * s.pdf;
    }
    EXPECT_GT(agreed, kSamples * 0.999);
    // Four right-angled pyramids from the foot of the perpendicular.
    double exact = 0;
    for (double x : {-1.2, 0.8}) {
      for (double z : {-1.1, 0.9}) {
        const double h = 0.7;
        exact += std::atan(std::fabs(x * z) / (h * std::sqrt(x * x + z * z + h * h)));
      }
    }
    EXPECT_NEAR(solidAngle, exact, 0.03 * exact);
  }
}

TEST(Lights, PunctualLightsFollowTheInverseSquare) {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {-5, -1, -5}, {0, 0, 10}, {10, 0, 0});
  core::PunctualLight point, spot, sun;
  point.position = {0, 2, 0};
  point.intensity = Vec3(8);
  spot.type = core::PunctualLight::Type::spot;
  spot.position = {0, 3, 0};
  spot.intensity = Vec3(9);
  spot.cosInner = 0.9f;
  spot.cosOuter = 0.8f;
  sun.type = core::PunctualLight::Type::directional;
  sun.direction = glm::normalize(Vec3(1, -1, 0));
  sun.intensity = Vec3(3);
  m.scene.lights = {point, spot, sun};
  const World world(m.scene, planOf());
  const Estimate e = irradianceBySampling(world, Vec3(0), {0, 1, 0}, 50000);
  EXPECT_NEAR(e.mean, 8 / 4.0 + 9 / 9.0 + 3 * std::sqrt(0.5), 4 * e.sigma);
  // Outside the cone only the other two are left.
  const Estimate side = irradianceBySampling(world, {4, 0, 0}, {0, 1, 0}, 50000);
  const double r2 = 4 + 16;
  EXPECT_NEAR(side.mean, 8 / r2 * 2 / std::sqrt(r2) + 3 * std::sqrt(0.5), 4 * side.sigma);
}

TEST(Lights, EmissionCarriesThePower) {
  SceneMaker m;
  core::Material both = lamp(3);
  both.doubleSided = true;
  m.quad(m.material(lamp(2)), 0, {0, 1, 0}, {2, 0, 0}, {0, 0, 2});
  m.quad(m.material(both), 0, {0, 4, 0}, {1, 0, 0}, {0, 0, 1});
  core::PunctualLight point;
  point.position = {0, 2, 0};
  point.intensity = Vec3(0.5f);
  m.scene.lights = {point};
  const World world(m.scene, planOf());
  std::mt19937 engine(23);
  std::uniform_real_distribution<float> u(0, 1);
  double flux = 0, upwards = 0;
  constexpr int kPhotons = 50000;
  for (int i = 0; i < kPhotons; ++i) {
    const EmissionSample s =
        world.lights().sampleEmission(u(engine), {u(engine), u(engine)}, {u(engine), u(engine)});
    flux += s.flux.x / kPhotons;
    if (s.normal != Vec3(0)) {
      EXPECT_GE(glm::dot(s.normal, s.direction), -1e-5f);
      if (s.direction.y > 0) upwards += s.flux.x / kPhotons;
    }
  }
  EXPECT_NEAR(flux, core::kPi * (2 * 4 + 2 * 3) + 4 * core::kPi * 0.5, 1e-2);
  EXPECT_NEAR(upwards, core::kPi * 3, 0.3);
  EXPECT_NEAR(world.lights().totalPower(), flux, 1e-2);
}

TEST(Lights, EmissionTexturesWeighTheTriangles) {
  SceneMaker m;
  core::Texture t;
  t.image = core::ImageRgba8(2, 1);
  t.image.at(0, 0) = {0, 0, 0, 255};
  t.image.at(1, 0) = {255, 255, 255, 255};
  t.nearest = true;
  t.wrapS = t.wrapT = core::Wrap::clamp;
  m.scene.textures.push_back(t);
  core::Material textured = lamp(4);
  textured.emissionTexture.texture = 0;
  // uv0 = (x, z): dark for x < 0.5. One quad in the dark, one in the light.
  m.quad(m.material(textured), 0, {0, 1, 0}, {0.4f, 0, 0}, {0, 0, 1});
  m.quad(0, 0, {0.6f, 1, 0}, {0.4f, 0, 0}, {0, 0, 1});
  const World world(m.scene, planOf());
  EXPECT_EQ(world.lights().emissiveCount(), 2u);
  const Vec3 point(0.5f, 0, 0.5f);
  const Estimate e = irradianceBySampling(world, point, {0, 1, 0}, 50000);
  const double exact =
      4 * polygonIrradiance(point, {0, 1, 0}, {{0.6f, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0.6f, 1, 1}});
  EXPECT_NEAR(e.mean, exact, 4 * e.sigma + 1e-4);
}

TEST(Lights, ABrightPatchOnABlackMeshIsNotLost) {
  // One triangle pair spans 512 x 512 texels, black but for 3 x 3 of them; uv0 = (x, z).
  for (const bool second : {false, true}) {
    SceneMaker m;
    core::Texture t;
    t.image = core::ImageRgba8(512, 512, {0, 0, 0, 255});
    for (int y = 100; y < 103; ++y) {
      for (int x = 301; x < 304; ++x) t.image.at(x, y) = {255, 255, 255, 255};
    }
    t.nearest = true;
    m.scene.textures.push_back(t);
    core::Material textured = lamp(1000);
    textured.emissionTexture.texture = 0;
    textured.emissionTexture.uvSet = second ? 1 : 0;
    m.quad(m.material(textured), 0, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
    if (second) {
      core::Mesh& mesh = m.scene.meshes.back();
      mesh.uv1 = mesh.uv0;
      for (Vec2& uv : mesh.uv0) uv = Vec2(0);  // all black
    }
    const World world(m.scene, planOf());
    EXPECT_GE(world.lights().emissiveCount(), 1u);
    const Vec3 point(0.5f, 0, 0.5f);
    const Estimate e = irradianceBySampling(world, point, {0, 1, 0}, 2000000);
    const auto at = [](float x, float z) { return Vec3(x / 512, 1, z / 512); };
    const double exact =
        1000 * polygonIrradiance(point, {0, 1, 0}, {at(301, 100), at(304, 100), at(304, 103), at(301, 103)});
    EXPECT_NEAR(e.mean, exact, 4 * e.sigma);
    EXPECT_LT(e.sigma, 0.15 * exact);
  }
}

TEST(Lights, RangeIsTheRecommendedWindow) {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {-5, -9, -5}, {0, 0, 10}, {10, 0, 0});
  core::PunctualLight light;
  light.position = {0, 2, 0};
  light.intensity = Vec3(8);
  light.range = 4;
  m.scene.lights = {light};
  const World world(m.scene, planOf());
  const auto at = [&](float y) { return irradianceBySampling(world, {0, y, 0}, {0, 1, 0}, 10).mean; };
  EXPECT_NEAR(at(1), 8 * (1 - std::pow(0.25, 4)), 1e-5);
  EXPECT_NEAR(at(-1), 8.0 / 9 * (1 - std::pow(0.75, 4)), 1e-5);
  EXPECT_EQ(at(-2), 0);
  EXPECT_EQ(at(-7), 0);
  EXPECT_EQ(rangeFactor(0, 1e30f), 1);
}

TEST(Lights, SpotFalloffAlsoWhereTheConesAreOne) {
  for (const float inner : {0.95f, 0.8f}) {
    core::PunctualLight spot;
    spot.type = core::PunctualLight::Type::spot;
    spot.cosInner = inner;
    spot.cosOuter = 0.8f;
    for (const float c : {1.0f, 0.96f, 0.9f, 0.85f, 0.79f, 0.0f, -1.0f}) {
      const float t = (c - 0.8f) / std::max(0.001f, inner - 0.8f), s = std::clamp(t, 0.0f, 1.0f);
      EXPECT_NEAR(spotFactor(spot, c), s * s, 1e-6) << c;
    }
  }
}

TEST(Lights, DirectionalParticlesCoverTheScene) {
  SceneMaker m;
  m.box(m.material(tests::diffuseMaterial(Vec3(1))), 0, {0, 0, 0}, {4, 1, 2});
  core::PunctualLight sun;
  sun.type = core::PunctualLight::Type::directional;
  sun.direction = glm::normalize(Vec3(1, -2, 0.5f));
  sun.intensity = Vec3(3);
  m.scene.lights = {sun};
  const World world(m.scene, planOf());
  std::mt19937 engine(24);
  std::uniform_real_distribution<float> u(0, 1);
  constexpr int kPhotons = 400000;
  double flux[2][2] = {};  // through quarters of the lid
  for (int i = 0; i < kPhotons; ++i) {
    const EmissionSample s =
        world.lights().sampleEmission(u(engine), {u(engine), u(engine)}, {u(engine), u(engine)});
    const Vec3 at = s.origin + s.direction * ((1 - s.origin.y) / s.direction.y);
    if (at.x < 0 || at.x > 4 || at.z < 0 || at.z > 2) continue;
    flux[at.x > 2][at.z > 1] += s.flux.x / kPhotons;
  }
  for (const auto& half : flux) {
    for (const double f : half) EXPECT_NEAR(f, 3 * -sun.direction.y * 2, 0.03 * 6);
  }
}

TEST(AliasTable, FollowsTheWeights) {
  const double weights[] = {1, 0, 3, 4};
  const AliasTable table(weights);
  EXPECT_EQ(table.total(), 8);
  int counts[4] = {};
  constexpr int kDraws = 80000;
  for (int i = 0; i < kDraws; ++i) {
    float rest = -1;
    ++counts[table.sample((static_cast<float>(i) + 0.5f) / kDraws, rest)];
    ASSERT_TRUE(rest >= 0 && rest < 1);
  }
  EXPECT_NEAR(counts[0], kDraws / 8, 2);
  EXPECT_EQ(counts[1], 0);
  EXPECT_NEAR(counts[2], kDraws * 3 / 8, 2);
  const double nothing[] = {0, 0};
  EXPECT_TRUE(AliasTable(nothing).empty());
}

TEST(AliasTable, Hard19DrawsOfZeroAndOneAreInside) {
  HardCase outside =
      HardCase::counting("alias table at u of 0 and 1: entries outside or of weight 0", "draws");
  for (const std::vector<double>& weights : {std::vector<double>{1, 0, 3, 4}, {0, 0, 1}, {5}, {1, 0}}) {
    const AliasTable table(weights);
    for (const float u : {0.0f, 0.99999994f, 1.0f}) {
      float rest = 0;
      const std::size_t i = table.sample(u, rest);
      EXPECT_TRUE(outside.within(!(i < weights.size() && weights[i] > 0 && rest >= 0 && rest <= 1), 0)) << u;
    }
  }
}

TEST(Lights, Hard19RandomNumbersOfZeroAndOneGiveSoundSamples) {
  SceneMaker m;
  m.quad(m.material(lamp(2)), 0, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  core::PunctualLight point;
  point.position = {0, 2, 3};
  point.intensity = Vec3(8);
  m.scene.lights = {point};
  const World world(m.scene, planOf());
  const LightChoice choice = world.lights().choose(Vec3(0));
  HardCase unsound =
      HardCase::counting("light samples and photons at u of 0 and 1 that are not finite", "samples");
  const auto finite = [](const Vec3& v) { return std::isfinite(v.x + v.y + v.z); };
  for (const float a : {0.0f, 0.99999994f, 1.0f}) {
    for (const float x : {0.0f, 0.99999994f, 1.0f}) {
      for (const float y : {0.0f, 0.99999994f, 1.0f}) {
        LightSample s;
        if (world.lights().sample(choice, a, {x, y}, s)) {
          const bool sound = finite(s.direction) && finite(s.radiance) && s.pdf > 0 && std::isfinite(s.pdf);
          EXPECT_TRUE(unsound.within(!sound, 0)) << a << x << y;
        }
        const EmissionSample e = world.lights().sampleEmission(a, {x, y}, {y, x});
        EXPECT_TRUE(unsound.within(!(finite(e.origin) && finite(e.direction) && finite(e.flux)), 0))
            << a << x << y;
      }
    }
  }
}

}  // namespace
}  // namespace saccade::raytrace
