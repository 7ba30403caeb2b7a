// Numerics 10, 11, 13-17, 19 of the hard cases: scattering.
#include "raytrace/bsdf.h"

#include <gtest/gtest.h>

#include <random>

#include "core/scene/specular_albedo.h"
#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

const float kCosines[] = {1.0f, 0.9f, 0.5f, 0.2f, 0.05f};
const float kRoughness[] = {0.0f, 0.05f, 0.1f, 0.3f, 0.5f, 0.7f, 1.0f};

TEST(Bsdf, MetalAlbedoEqualsTheTable) {
  for (float roughness : kRoughness) {
    for (float cosine : kCosines) {
      Patch s = patch(1, roughness, 0, false);
      s.surface.point.baseColor = Vec3(0.7f);
      bind(s);
      const Estimate e = sampledAlbedo(s.at(cosine), kLobeSpecular, 100000, 7);
      const core::AlbedoPair pair = core::directionalAlbedo(cosine, roughness);
      // Beside the noise, the error of the table's own quadrature and interpolation.
      EXPECT_NEAR(e.mean, 0.7f * pair.scale + pair.bias, 3 * e.sigma + 6e-3) << roughness << " " << cosine;
      EXPECT_LE(e.mean, 1 + 3 * e.sigma);
    }
  }
}

TEST(Bsdf, FurnaceNeverExceedsOne) {
  struct Kind {
    float metallic, transmission;
    bool closed;
    float ior;
  };
  const Kind kinds[] = {{0, 0, false, 1.5f},   {0.5f, 0, false, 1.5f}, {0, 1, true, 1.5f},
                        {0, 1, false, 1.5f},   {0, 0.5f, true, 1.3f},  {0, 0, false, 3},
                        {0.3f, 0.6f, true, 2}, {0, 1, true, 1}};
  for (const Kind& k : kinds) {
    for (float roughness : kRoughness) {
      for (float cosine : kCosines) {
        for (bool front : {true, false}) {
          Patch s = patch(k.metallic, roughness, k.transmission, k.closed, k.ior);
          s.material.doubleSided = true;
          s.surface.front = front;
          bind(s);
          const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 20000, 8);
          EXPECT_LE(e.mean, 1 + 3 * e.sigma + 2e-3)
              << "metallic " << k.metallic << " transmission " << k.transmission << " ior " << k.ior
              << " roughness " << roughness << " cosine " << cosine << " front " << front;
        }
      }
    }
  }
}

TEST(Bsdf, SmoothGlassLosesNothing) {
  for (bool closed : {true, false}) {
    for (float cosine : kCosines) {
      Patch s = patch(0, 0, 1, closed);
      bind(s);
      const Bsdf bsdf = s.at(cosine);
      const auto through = bsdf.deltaTransmission();
      ASSERT_TRUE(through);
      EXPECT_NEAR(bsdf.deltaReflection().weight.x + through->weight.x, 1, 1e-6);
    }
  }
}

TEST(Bsdf, LayeredLambertUnderConstantLightIsWhatTheMapsGive) {
  // The integral of f_d cos over the hemisphere = pi diffuseUnderMap.
  for (float roughness : {0.2f, 0.6f, 1.0f}) {
    for (float cosine : {1.0f, 0.6f, 0.2f}) {
      Patch s = patch(0, roughness, 0, false);
      bind(s);
      const Bsdf bsdf = s.at(cosine);
      const Estimate e = sampledAlbedo(bsdf, kLobeDiffuse, 50000, 9);
      EXPECT_NEAR(e.mean, core::kPi * bsdf.diffuseUnderMap().x, 3 * e.sigma + 2e-3);
    }
  }
}

TEST(Bsdf, RoughnessTowardsZeroJoinsTheMirror) {
  // Roughness just above and below the threshold: same directions, same weights.
  const float threshold = std::sqrt(kDeltaAlpha);
  for (float transmission : {0.0f, 1.0f}) {
    for (float cosine : {1.0f, 0.5f, 0.1f}) {
      Patch smooth = patch(transmission > 0 ? 0.0f : 1.0f, threshold * 0.99f, transmission, true);
      Patch rough = patch(transmission > 0 ? 0.0f : 1.0f, threshold * 1.01f, transmission, true);
      bind(smooth);
      bind(rough);
      const Bsdf a = smooth.at(cosine), b = rough.at(cosine);
      ASSERT_TRUE(a.delta());
      ASSERT_FALSE(b.delta());
      for (float uLobe : {0.001f, 0.999f}) {
        const auto x = a.sample(uLobe, {0.5f, 0.3f}, kLobeSpecular),
                   y = b.sample(uLobe, {0.5f, 0.3f}, kLobeSpecular);
        ASSERT_TRUE(x && y);
        EXPECT_LT(glm::length(x->direction - y->direction), 0.02f);
        EXPECT_NEAR(x->weight.x, y->weight.x, 0.01);
      }
    }
  }
}

TEST(Bsdf, DensityOfFacetNormals) {
  for (float alpha : {1e-3f, 0.1f, 1.0f}) {
    EXPECT_FLOAT_EQ(ggxD({0, 0, 1}, alpha), 1 / (core::kPi * alpha * alpha));
    // Projected area: the integral of D cos = 1 (Walter 2007, equation 4), t = tan^2.
    double sum = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double u = (i + 0.5) / kSteps;
      const double cosine = u, sine = std::sqrt(1 - u * u);
      if (alpha < 0.01f) continue;
      sum +=
          2 * M_PI * ggxD({static_cast<float>(sine), 0, static_cast<float>(cosine)}, alpha) * cosine / kSteps;
    }
    if (alpha >= 0.01f) {
      EXPECT_NEAR(sum, 1, 2e-3);
    }
  }
}

TEST(Fresnel, Dielectric) {
  EXPECT_NEAR(fresnelDielectric(1, 1.5f), 0.04, 1e-6);
  EXPECT_NEAR(fresnelDielectric(1, 1 / 1.5f), 0.04, 1e-6);
  EXPECT_FLOAT_EQ(fresnelDielectric(0, 1.5f), 1);
  for (float c : {1.0f, 0.5f, 0.1f}) EXPECT_NEAR(fresnelDielectric(c, 1), 0, 1e-6);
  // Total internal reflection joins at the critical angle: cos^2 = 1 - eta^2.
  const float eta = 1 / 1.5f, critical = std::sqrt(1 - eta * eta);
  EXPECT_EQ(fresnelDielectric(critical * 0.999f, eta), 1);
  EXPECT_GT(fresnelDielectric(critical * 1.000001f, eta), 0.98f);
  // Stokes: the same from both sides along one path.
  const float cosI = 0.7f, sinT = std::sqrt(1 - cosI * cosI) / 1.5f;
  EXPECT_NEAR(fresnelDielectric(cosI, 1.5f), fresnelDielectric(std::sqrt(1 - sinT * sinT), 1 / 1.5f), 1e-6);
}

TEST(Bsdf, Reciprocity) {
  std::mt19937 engine(10);
  std::uniform_real_distribution<float> u(0.05f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s = patch(i % 3 == 0 ? 1.0f : 0.3f, 0.1f + 0.9f * u(engine), 0, false);
    bind(s);
    const float cv = u(engine), cl = u(engine), phi = 6 * u(engine);
    const Vec3 v(std::sqrt(1 - cv * cv), 0, cv);
    const Vec3 l(std::sqrt(1 - cl * cl) * std::cos(phi), std::sqrt(1 - cl * cl) * std::sin(phi), cl);
    const float forth = Bsdf(s.surface, v).eval(l, kLobeAll).x / l.z;
    const float back = Bsdf(s.surface, l).eval(v, kLobeAll).x / v.z;
    ASSERT_NEAR(forth, back, 1e-4f * std::max(1.0f, forth));
  }
}

TEST(Bsdf, ReciprocityThroughAnInterface) {
  // Without the radiance's eta^2, f(v -> l) / eta_l^2 is what both ways share (Walter 2007, section 5.2).
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> u(0.2f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s = patch(0, 0.3f + 0.7f * u(engine), 1, true);
    bind(s);
    const float cv = u(engine), cl = u(engine), phi = 6 * u(engine);
    const Vec3 v(std::sqrt(1 - cv * cv), 0, cv);
    const Vec3 l(std::sqrt(1 - cl * cl) * std::cos(phi), std::sqrt(1 - cl * cl) * std::sin(phi), -cl);
    const float forth = Bsdf(s.surface, v).eval(l, kLobeSpecular).x / cl;
    Surface behind = s.surface;
    behind.front = false;
    behind.ng = behind.ns = Vec3(0, 0, -1);
    const float back = Bsdf(behind, l).eval(v, kLobeSpecular).x / cv;
    ASSERT_NEAR(forth, 1.5f * 1.5f * back, 1e-3f * std::max(1.0f, forth)) << i;
  }
}

TEST(Bsdf, SampledDirectionsFollowTheDensity) {
  constexpr int kCases = 3 * 3 * 4;
  for (float roughness : {0.5f, 0.8f, 1.0f}) {
    for (float cosine : {0.95f, 0.5f, 0.2f}) {
      SCOPED_TRACE("roughness " + std::to_string(roughness) + " cosine " + std::to_string(cosine));
      Patch metal = patch(1, roughness, 0, false), plastic = patch(0, roughness, 0, false);
      Patch glass = patch(0, roughness, 1, true), sheet = patch(0, roughness, 1, false);
      for (Patch* s : {&metal, &plastic, &glass, &sheet}) bind(*s);
      expectDensity(metal.at(cosine), kLobeAll, kCases);
      expectDensity(plastic.at(cosine), kLobeAll, kCases);
      expectDensity(glass.at(cosine), kLobeSpecular, kCases);
      expectDensity(sheet.at(cosine), kLobeSpecular, kCases);
    }
  }
}

TEST(Bsdf, WeightIsValueOverDensity) {
  std::mt19937 engine(13);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 2000; ++i) {
    Patch s = patch(i % 2 ? 0.4f : 0.0f, 0.3f + 0.7f * u(engine), i % 3 ? 0.5f : 0.0f, i % 5 != 0);
    bind(s);
    const Bsdf bsdf = s.at(0.1f + 0.9f * u(engine));
    const auto x = bsdf.sample(u(engine), {u(engine), u(engine)}, kLobeAll);
    if (!x || x->pdf < 1e-3f) continue;
    const Vec3 f = bsdf.eval(x->direction, kLobeAll);
    ASSERT_NEAR(x->weight.x * x->pdf, f.x, 2e-2f * f.x + 1e-4f);
  }
}

TEST(Bsdf, OppositeDirectionsAndExtremeNumbersStayFinite) {
  for (float roughness : {0.05f, 0.5f, 1.0f}) {
    for (float ior : {1.0f, 1.0005f, 1.5f}) {
      for (bool front : {true, false}) {
        Patch s = patch(0.2f, roughness, 0.7f, true, ior);
        s.surface.front = front;
        bind(s);
        for (float cosine : {1.0f, 0.3f, 1e-7f, 0.0f}) {
          const Vec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
          const Bsdf bsdf(s.surface, v);
          for (const Vec3& wi : {-v, v, Vec3(-v.x, 0, v.z), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, -1)}) {
            const Vec3 f = bsdf.eval(wi, kLobeAll);
            EXPECT_TRUE(std::isfinite(f.x) && f.x >= 0);
            const float p = bsdf.pdf(wi, kLobeAll);
            EXPECT_TRUE(std::isfinite(p) && p >= 0);
          }
          for (float a : {0.0f, 0.5f, 0.99999994f, 1.0f}) {
            const auto x = bsdf.sample(std::min(a, 0.99999994f), {a, a}, kLobeAll);
            if (!x) continue;
            EXPECT_TRUE(std::isfinite(x->weight.x) && x->weight.x >= 0 && std::isfinite(x->pdf))
                << "roughness " << roughness << " ior " << ior << " front " << front << " cosine " << cosine
                << " u " << a << " weight " << x->weight.x << " pdf " << x->pdf;
            EXPECT_NEAR(glm::length(x->direction), 1, 1e-4);
          }
        }
      }
    }
  }
}

TEST(Bsdf, NormalsThatDisagreeLeakNoLight) {
  std::mt19937 engine(14);
  std::uniform_real_distribution<float> u(-1, 1);
  for (int i = 0; i < 3000; ++i) {
    Patch s = patch(i % 2 ? 1.0f : 0.0f, i % 4 ? 0.4f : 0.0f, 0, false);
    bind(s);
    s.surface.ns = glm::normalize(Vec3(u(engine), u(engine), std::fabs(u(engine)) + 0.05f));
    const Vec3 v = glm::normalize(Vec3(u(engine), u(engine), std::fabs(u(engine)) + 0.05f));
    if (glm::dot(v, s.surface.ns) <= 0) continue;
    const Bsdf bsdf(s.surface, v);
    Vec3 below = glm::normalize(Vec3(u(engine), u(engine), -std::fabs(u(engine)) - 0.01f));
    EXPECT_EQ(bsdf.eval(below, kLobeAll), Vec3(0));
    const auto x = bsdf.sample(0.5f * (u(engine) + 1) * 0.999f, Vec2(0.3f, 0.7f), kLobeAll);
    if (x) {
      EXPECT_GT(x->direction.z, 0);
    }
  }
}

TEST(Frame, IsOrthonormalEverywhere) {
  std::mt19937 engine(15);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<Vec3> normals = {
      {0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}, glm::normalize(Vec3(1e-4f, 0, -1))};
  for (int i = 0; i < 1000; ++i)
    normals.push_back(glm::normalize(Vec3(u(engine), u(engine), u(engine) + 1e-3f)));
  for (const Vec3& n : normals) {
    const Frame f(n);
    EXPECT_NEAR(glm::dot(f.t, f.b), 0, 1e-5);
    EXPECT_NEAR(glm::dot(f.t, f.n), 0, 1e-5);
    EXPECT_NEAR(glm::dot(glm::cross(f.t, f.b), f.n), 1, 1e-5);
    EXPECT_LT(glm::length(f.toWorld(f.toLocal(Vec3(1, 2, 3))) - Vec3(1, 2, 3)), 1e-4f);
  }
}

}  // namespace
}  // namespace saccade::raytrace
