// Numerics 7 and 8 of the hard cases: light sampling against analytic truths.
#include "raytrace/lights.h"

#include <gtest/gtest.h>

#include <random>

#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::planOf;
using tests::SceneMaker;

struct Estimate {
  double mean, sigma;
};

/// Irradiance at a point with a normal, by light sampling; blockers count.
Estimate irradianceBySampling(const World& world, const Vec3& point, const Vec3& normal, int n) {
  std::mt19937 engine(21);
  std::uniform_real_distribution<float> u(0, 1);
  RayCounters counters;
  Surface from;
  from.position = point;
  from.ng = from.ns = normal;
  const LightChoice choice = world.lights().choose(point);
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    LightSample s;
    double e = 0;
    if (world.lights().sample(choice, u(engine), {u(engine), u(engine)}, s)) {
      const float cosine = std::max(0.0f, glm::dot(s.direction, normal));
      if (cosine > 0) e = s.radiance.x * cosine / s.pdf * world.transmittance(shadowRay(from, s), counters);
    }
    sum += e;
    squares += e * e;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

/// Irradiance from a polygon of radiance 1 above the horizon of `normal` (Lambert's formula), after clipping.
double polygonIrradiance(const Vec3& point, const Vec3& normal, const std::vector<Vec3>& corners) {
  std::vector<glm::dvec3> clipped;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a(corners[i] - point), b(corners[(i + 1) % corners.size()] - point), n(normal);
    const double da = glm::dot(a, n), db = glm::dot(b, n);
    if (da >= 0) clipped.push_back(a);
    if ((da > 0) != (db > 0) && da != db) clipped.push_back(a + (b - a) * (da / (da - db)));
  }
  double sum = 0;
  for (std::size_t i = 0; i < clipped.size(); ++i) {
    const glm::dvec3 a = glm::normalize(clipped[i]), b = glm::normalize(clipped[(i + 1) % clipped.size()]);
    const glm::dvec3 cross = glm::cross(a, b);
    if (glm::length(cross) < 1e-12) continue;
    sum += std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) *
           glm::dot(glm::normalize(cross), glm::dvec3(normal));
  }
  return std::fabs(sum) / 2;
}

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
