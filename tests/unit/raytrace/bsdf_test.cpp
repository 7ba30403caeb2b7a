// Numerics 10, 11, 13, 14, 16, 17 of the hard cases: scattering by the lobes without extensions.
#include "raytrace/bsdf.h"

#include <gtest/gtest.h>

#include <random>

#include "core/scene/specular_albedo.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

const float kCosines[] = {1.0f, 0.9f, 0.5f, 0.2f, 0.05f};
const float kRoughness[] = {0.0f, 0.05f, 0.1f, 0.3f, 0.5f, 0.7f, 1.0f};

TEST(Bsdf, Hard10MetalAlbedoEqualsTheTable) {
  HardCase table("albedo of GGX metal against its table");
  for (float roughness : kRoughness) {
    for (float cosine : kCosines) {
      Patch s = patch(1, roughness, 0, false);
      s.surface.point.baseColor = Vec3(0.7f);
      bind(s);
      const Estimate e = sampledAlbedo(s.at(cosine), kLobeSpecular, 100000, 7);
      const core::AlbedoPair pair = core::directionalAlbedo(cosine, roughness);
      // Beside the noise, the error of the table's own quadrature and interpolation.
      EXPECT_TRUE(table.near(e.mean, 0.7f * pair.scale + pair.bias, 3 * e.sigma + 6e-3))
          << roughness << " " << cosine;
    }
  }
}

TEST(Bsdf, Hard10SingleScatterGgxOfAlphaOneReflectsOneMinusTheLogarithmOfTwo) {
  // v = n: Lambda(v) = 0 and D = 1/pi, so that E = integral of c / (1 + c) over c in [0, 1].
  const double exact = 1 - std::log(2.0);
  Patch s = patch(1, 1, 0, false);
  bind(s);
  const Estimate e = sampledAlbedo(s.at(1), kLobeSpecular, 200000, 7);
  EXPECT_TRUE(HardCase("single-scatter GGX, alpha 1, normal incidence, by sampling")
                  .near(e.mean, exact, 3 * e.sigma));
  const core::AlbedoPair pair = core::directionalAlbedo(1, 1);
  EXPECT_TRUE(HardCase("single-scatter GGX, alpha 1, normal incidence, the table")
                  .near(pair.scale + pair.bias, exact, 6e-3));
}

TEST(Bsdf, Hard10FurnaceNeverExceedsOne) {
  HardCase furnace("white furnace, metal, plastic, glass and mixtures");
  struct Kind {
    float metallic, transmission;
    bool closed;
    float ior;
  };
  const Kind kinds[] = {{1, 0, false, 1.5f}, {0, 0, false, 1.5f},   {0.5f, 0, false, 1.5f},
                        {0, 1, true, 1.5f},  {0, 1, false, 1.5f},   {0, 0.5f, true, 1.3f},
                        {0, 0, false, 3},    {0.3f, 0.6f, true, 2}, {0, 1, true, 1}};
  for (const Kind& k : kinds) {
    for (float roughness : kRoughness) {
      for (float cosine : kCosines) {
        for (bool front : {true, false}) {
          Patch s = patch(k.metallic, roughness, k.transmission, k.closed, k.ior);
          s.material.doubleSided = true;
          s.surface.front = front;
          bind(s);
          const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 20000, 8);
          EXPECT_TRUE(furnace.within(e.mean - 1, 3 * e.sigma + 2e-3))
              << "metallic " << k.metallic << " transmission " << k.transmission << " ior " << k.ior
              << " roughness " << roughness << " cosine " << cosine << " front " << front;
        }
      }
    }
  }
}

TEST(Bsdf, FourSamplesAtOnceHaveTheBitsOfEachAlone) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 0x1.fffffep-1f);
  int drawn = 0, refused = 0;
  for (float metallic : {0.0f, 0.5f, 1.0f}) {
    for (float roughness : {0.05f, 0.1f, 0.3f, 0.7f, 1.0f}) {
      for (float cosine : kCosines) {
        Patch s = patch(metallic, roughness, 0, false);
        s.surface.point.baseColor = Vec3(0.9f, 0.4f, 0.1f);
        s.surface.ng = glm::normalize(Vec3(0.3f, -0.2f, 1));  // some directions pass below the surface
        bind(s);
        const Bsdf bsdf = s.at(cosine, roughness);
        ASSERT_TRUE(bsdf.plain());
        for (int i = 0; i < 100; ++i) {
          Vec2 u[kLanes];
          for (Vec2& pair : u) pair = {uniform(engine), uniform(engine)};
          const BsdfLanes four = bsdf.sampleLanes(u);
          for (int k = 0; k < kLanes; ++k) {
            const std::optional<BsdfSample> one = bsdf.sample(0, u[k], kLobeBase);
            ASSERT_EQ(four.side[k] > 0, one.has_value());
            ++(one ? drawn : refused);
            if (!one) continue;
            EXPECT_EQ(four.direction[k], one->direction);
            EXPECT_EQ(four.weight[k], one->weight);
            EXPECT_EQ(four.pdf[k], one->pdf);
          }
        }
      }
    }
  }
  EXPECT_GT(drawn, 10000);
  EXPECT_GT(refused, 1000);
}

TEST(Bsdf, OnlyPlainReflectionIsSampledFourAtOnce) {
  Patch glass = patch(0, 0.3f, 0.5f, true), mirror = patch(1, 0, 0, false), filmed = patch(1, 0.3f, 0, false),
        coated = filmed, brushed = filmed;
  filmed.extension().film = {1, 1.3f, 400};
  coated.extension().clearcoat = 1;
  brushed.extension().anisotropy = 0.5f;
  for (Patch* s : {&glass, &mirror, &filmed, &coated, &brushed}) {
    bind(*s);
    EXPECT_FALSE(s->at(0.5f).plain());
  }
}

TEST(Bsdf, Hard10SmoothGlassLosesNothing) {
  HardCase lost("white furnace, smooth glass: reflected and transmitted sum to 1");
  for (bool closed : {true, false}) {
    for (float cosine : kCosines) {
      Patch s = patch(0, 0, 1, closed);
      bind(s);
      const Bsdf bsdf = s.at(cosine);
      const auto through = bsdf.deltaTransmission();
      ASSERT_TRUE(through);
      EXPECT_TRUE(lost.near(bsdf.deltaReflection().weight.x + through->weight.x, 1, 1e-6)) << cosine;
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

TEST(Bsdf, Hard11RoughnessTowardsZeroJoinsTheMirror) {
  HardCase jump("direction at the threshold of metal and glass", "radians"),
      step("weight at the threshold of metal and glass");
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
        EXPECT_TRUE(jump.within(glm::length(x->direction - y->direction), 0.02)) << cosine;
        EXPECT_TRUE(step.near(x->weight.x, y->weight.x, 0.01)) << cosine;
      }
    }
  }
}

TEST(Bsdf, Hard11DensityOfFacetNormals) {
  HardCase peak("D(0) = 1 / (pi alpha^2), relative"), projected("projected area of GGX facets is 1");
  for (float alpha : {1e-3f, 0.1f, 1.0f}) {
    const double exact = 1 / (M_PI * alpha * alpha);
    EXPECT_TRUE(peak.near(ggxD({0, 0, 1}, alpha) / exact, 1, 5e-7)) << alpha;
  }
  for (float alpha : {0.1f, 1.0f}) {
    // The integral of D cos = 1 (Walter 2007, equation 4).
    double sum = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps, sine = std::sqrt(1 - cosine * cosine);
      const Vec3 h(static_cast<float>(sine), 0, static_cast<float>(cosine));
      sum += 2 * M_PI * ggxD(h, alpha) * cosine / kSteps;
    }
    EXPECT_TRUE(projected.near(sum, 1, 2e-3)) << alpha;
  }
}

TEST(Bsdf, Hard14Reciprocity) {
  HardCase ways("reciprocity, metal and plastic, relative above 1");
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
    ASSERT_TRUE(ways.within(std::fabs(forth - back) / std::max(1.0f, forth), 1e-4));
  }
}

TEST(Bsdf, Hard14ReciprocityThroughAnInterface) {
  HardCase ways("reciprocity through rough glass, relative above 1");
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
    ASSERT_TRUE(ways.within(std::fabs(forth - 2.25f * back) / std::max(1.0f, forth), 1e-3)) << i;
  }
}

TEST(Bsdf, Hard14SampledDirectionsFollowTheDensity) {
  HardCase chance("chi-squared of directions, metal, plastic, glass and sheets", "-log10 p");
  constexpr int kCases = 3 * 3 * 4;
  for (float roughness : {0.5f, 0.8f, 1.0f}) {
    for (float cosine : {0.95f, 0.5f, 0.2f}) {
      SCOPED_TRACE("roughness " + std::to_string(roughness) + " cosine " + std::to_string(cosine));
      Patch metal = patch(1, roughness, 0, false), plastic = patch(0, roughness, 0, false);
      Patch glass = patch(0, roughness, 1, true), sheet = patch(0, roughness, 1, false);
      for (Patch* s : {&metal, &plastic, &glass, &sheet}) bind(*s);
      expectDensity(metal.at(cosine), kLobeAll, kCases, chance);
      expectDensity(plastic.at(cosine), kLobeAll, kCases, chance);
      expectDensity(glass.at(cosine), kLobeSpecular, kCases, chance);
      expectDensity(sheet.at(cosine), kLobeSpecular, kCases, chance);
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

TEST(Bsdf, Hard16NormalsThatDisagreeLeakNoLight) {
  std::mt19937 engine(14);
  std::uniform_real_distribution<float> u(-1, 1);
  int evaluated = 0, sampled = 0;
  for (int i = 0; i < 30000; ++i) {
    Patch s = patch(i % 2 ? 1.0f : 0.0f, i % 4 ? 0.4f : 0.0f, 0, false);
    bind(s);
    s.surface.ns = glm::normalize(Vec3(u(engine), u(engine), std::fabs(u(engine)) + 0.05f));
    const Vec3 v = glm::normalize(Vec3(u(engine), u(engine), std::fabs(u(engine)) + 0.05f));
    if (glm::dot(v, s.surface.ns) <= 0) continue;
    const Bsdf bsdf(s.surface, v);
    const Vec3 below = glm::normalize(Vec3(u(engine), u(engine), -std::fabs(u(engine)) - 0.01f));
    evaluated += bsdf.eval(below, kLobeAll) != Vec3(0);
    const auto x = bsdf.sample(0.5f * (u(engine) + 1) * 0.999f, Vec2(0.3f, 0.7f), kLobeAll);
    sampled += x && !(x->direction.z > 0);
  }
  EXPECT_TRUE(HardCase::counting("light from below the surface", "directions").within(evaluated, 0));
  EXPECT_TRUE(HardCase::counting("directions drawn below the surface", "directions").within(sampled, 0));
}

TEST(Frame, Hard17IsOrthonormalEverywhere) {
  std::mt19937 engine(15);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<Vec3> normals = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -0.99999994f}};
  for (float e = 1e-2f; e > 1e-38f; e *= 0.1f) normals.push_back(glm::normalize(Vec3(e, -e, -1)));
  for (int i = 0; i < 1000; ++i)
    normals.push_back(glm::normalize(Vec3(u(engine), u(engine), u(engine) + 1e-3f)));
  HardCase error("basis at (0, 0, -1) and around: departure from orthonormal");
  for (const Vec3& n : normals) {
    const Frame f(n);
    for (const float product : {glm::dot(f.t, f.b), glm::dot(f.t, f.n), glm::dot(f.b, f.n)})
      EXPECT_TRUE(error.near(product, 0, 1e-6)) << n.z;
    for (const float square : {glm::dot(f.t, f.t), glm::dot(f.b, f.b), glm::dot(glm::cross(f.t, f.b), f.n)})
      EXPECT_TRUE(error.near(square, 1, 1e-6)) << n.z;
  }
}

}  // namespace
}  // namespace saccade::raytrace
