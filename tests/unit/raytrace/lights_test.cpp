// Numerics 7 and 8 of the hard cases: light sampling against analytic truths.
#include "raytrace/lights.h"

#include <gtest/gtest.h>

#include <random>

#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/unit/raytrace/irradiance.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::planOf;
using tests::SceneMaker;

core::Material lamp(float radiance) { return tests::diffuseMaterial(Vec3(0), Vec3(radiance)); }

TEST(Lights, DiskAboveAPoint) {
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
  const Estimate e = irradianceBySampling(world, Vec3(0), {0, 1, 0}, 100000);
  const double exact = core::kPi * 5 * kRadius * kRadius / (kRadius * kRadius + kHeight * kHeight);
  EXPECT_NEAR(e.mean, exact, 4 * e.sigma + 1e-3 * exact);
}

TEST(Lights, RectangleAlsoWhenTheHorizonCutsIt) {
  SceneMaker m;
  const Vec3 corner(-0.5f, 1, -0.3f), e1(1, 0, 0), e2(0, 0, 0.9f);
  m.quad(m.material(lamp(2)), 0, corner, e1, e2);  // cross(x, z) = -y: down
  const World world(m.scene, planOf());
  for (const Vec3& normal :
       {Vec3(0, 1, 0), glm::normalize(Vec3(1, 0.2f, 0)), glm::normalize(Vec3(1, -0.2f, 0.3f))}) {
    const Vec3 point(0.1f, 0, 0.2f);
    const Estimate e = irradianceBySampling(world, point, normal, 100000);
    const double exact =
        2 * polygonIrradiance(point, normal, {corner, corner + e1, corner + e1 + e2, corner + e2});
    ASSERT_GT(exact, 0.01);
    EXPECT_NEAR(e.mean, exact, 4 * e.sigma + 1e-4) << normal.x << " " << normal.y;
  }
}

TEST(Lights, BehindGrazingAndWithoutAreaGiveExactlyZero) {
  SceneMaker m;
  const int material = m.material(lamp(2));
  m.quad(material, 0, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});  // faces down, y = 1
  const World world(m.scene, planOf());
  EXPECT_EQ(irradianceBySampling(world, {0, 2, 0}, {0, -1, 0}, 1000).mean, 0);  // behind it
  EXPECT_EQ(irradianceBySampling(world, {3, 1, 0}, {-1, 0, 0}, 1000).mean, 0);  // in its plane
  EXPECT_EQ(irradianceBySampling(world, {0, 0, 0}, {0, -1, 0}, 1000).mean, 0);  // below the horizon
  SceneMaker flat;
  flat.mesh(flat.material(lamp(2)), 0, {{0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, {0, 1, 2});
  const World none(flat.scene, planOf());
  EXPECT_TRUE(none.lights().empty());
  EXPECT_EQ(irradianceBySampling(none, Vec3(0), {0, 1, 0}, 10).mean, 0);
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
  float rest = 0;
  EXPECT_LT(table.sample(1.0f, rest), 4u);  // u = 1 exactly
  const double nothing[] = {0, 0};
  EXPECT_TRUE(AliasTable(nothing).empty());
}

}  // namespace
}  // namespace saccade::raytrace
