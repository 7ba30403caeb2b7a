// Clearcoat and sheen over every base.
#include "raytrace/layers.h"

#include <gtest/gtest.h>

#include "core/scene/sheen.h"
#include "core/scene/specular_albedo.h"
#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

const float kCosines[] = {1.0f, 0.7f, 0.3f, 0.05f};
const float kRoughness[] = {0.0f, 0.1f, 0.3f, 0.6f, 1.0f};

struct Base {
  const char* name;
  float metallic, roughness, transmission;
  bool closed;
};
const Base kBases[] = {{"metal", 1, 0.4f, 0, false},        {"plastic", 0, 0.5f, 0, false},
                       {"mirror", 1, 0, 0, false},          {"solid", 0, 0.3f, 1, true},
                       {"sheet", 0, 0.3f, 1, false},        {"clear solid", 0, 0, 1, true},
                       {"mixture", 0.3f, 0.6f, 0.4f, true}, {"chalk", 0, 1, 0, false}};

Patch over(const Base& base, float coat, float coatRoughness, const Vec3& sheen, float sheenRoughness) {
  Patch s = patch(base.metallic, base.roughness, base.transmission, base.closed);
  ExtensionPoint& e = s.extension();
  e.clearcoat = coat;
  e.clearcoatRoughness = coatRoughness;
  e.sheenColor = sheen;
  e.sheenRoughness = sheenRoughness;
  return s;
}

/// A black base: index 1, no colour.
Patch overNothing(float coat, float coatRoughness, const Vec3& sheen, float sheenRoughness) {
  Patch s = over({"nothing", 0, 1, 0, false}, coat, coatRoughness, sheen, sheenRoughness);
  s.surface.point.baseColor = s.surface.point.dielectricF0 = Vec3(0);
  s.surface.point.dielectricF90 = 0;
  return s;
}

TEST(Coat, Hard10AlbedoEqualsTheTable) {
  HardCase table("albedo of clearcoat against its table");
  for (float roughness : kRoughness) {
    for (float cosine : kCosines) {
      Patch s = overNothing(1, roughness, Vec3(0), 0);
      bind(s);
      const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 40000, 7);
      // Beside the noise, the error of the table's own quadrature and interpolation.
      EXPECT_TRUE(table.near(e.mean, 1 - core::coatTransmission(1, roughness, cosine), 3 * e.sigma + 4e-3))
          << roughness << " " << cosine;
    }
  }
}

TEST(Sheen, Hard10AlbedoEqualsTheTable) {
  HardCase table("albedo of sheen against its table"), furnace("white furnace, sheen, its table");
  for (float roughness : kRoughness) {
    for (float cosine : kCosines) {
      Patch s = overNothing(0, 0, Vec3(1, 0.5f, 0), roughness);
      bind(s);
      const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 100000, 8);
      EXPECT_TRUE(table.near(e.mean, core::sheenAlbedo(cosine, roughness), 3 * e.sigma + 2e-3))
          << roughness << " " << cosine;
      EXPECT_TRUE(furnace.within(core::sheenAlbedo(cosine, roughness) - 1, 0));
    }
  }
}

TEST(Sheen, MeanAlbedoIsTheMeanOfTheTable) {
  for (float roughness : kRoughness) {
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      const float c = (static_cast<float>(i) + 0.5f) / 2000;
      sum += 2.0 * c * core::sheenAlbedo(c, roughness) / 2000;
    }
    EXPECT_NEAR(core::sheenMeanAlbedo(roughness), sum, 1e-4);
  }
}

TEST(Layers, Hard10FurnaceNeverExceedsOne) {
  HardCase furnace("white furnace, clearcoat and sheen over eight bases");
  for (const Base& base : kBases) {
    for (float roughness : kRoughness) {
      for (float cosine : kCosines) {
        for (int layers = 1; layers <= 3; ++layers) {
          for (bool front : {true, false}) {
            if (!front && !base.closed) continue;
            Patch s = over(base, layers & 1 ? 1.0f : 0.0f, roughness, Vec3(layers & 2 ? 1.0f : 0.0f),
                           1 - 0.9f * roughness);
            s.surface.front = front;
            bind(s);
            const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 4000, 9);
            EXPECT_TRUE(furnace.within(e.mean - 1, 4 * e.sigma + 2e-3))
                << base.name << " layers " << layers << " roughness " << roughness << " cosine " << cosine
                << " front " << front;
          }
        }
      }
    }
  }
}

TEST(Layers, Hard10CoatWithANormalOfItsOwnStaysWithinTheFurnace) {
  HardCase furnace("white furnace, clearcoat with a normal of its own");
  for (float tilt : {0.2f, 0.6f}) {
    for (float azimuth : {0.0f, 2.0f, 4.0f}) {
      for (float cosine : kCosines) {
        Patch s = over(kBases[1], 1, 0.2f, Vec3(0), 0);
        s.extension().coatNormal = Patch::direction(std::cos(tilt), azimuth);
        bind(s);
        const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 20000, 10);
        EXPECT_TRUE(furnace.within(e.mean - 1, 4 * e.sigma + 2e-3))
            << tilt << " " << azimuth << " " << cosine;
      }
    }
  }
}

TEST(Layers, LambertUnderConstantLightIsWhatTheMapsGive) {
  for (int layers = 1; layers <= 3; ++layers) {
    for (float roughness : {0.1f, 0.6f, 1.0f}) {
      for (float cosine : kCosines) {
        Patch s =
            over(kBases[1], layers & 1 ? 1.0f : 0.0f, roughness, Vec3(layers & 2 ? 0.8f : 0.0f), roughness);
        bind(s);
        const Bsdf bsdf = s.at(cosine);
        const Estimate e = sampledAlbedo(bsdf, kLobeDiffuse, 20000, 11);
        EXPECT_NEAR(e.mean, core::kPi * bsdf.diffuseUnderMap().x, 3 * e.sigma + 2e-3);
      }
    }
  }
}

TEST(Layers, BaseFactorIsTheMeanOfWhatTheMapsGive) {
  core::Material m;
  m.metallic = 0;
  m.roughness = 0.5f;
  m.clearcoat = 0.7f;
  m.clearcoatRoughness = 0.3f;
  m.sheenColor = Vec3(0.6f);
  m.sheenRoughness = 0.4f;
  Patch s = over({"", 0, 0.5f, 0, false}, m.clearcoat, m.clearcoatRoughness, m.sheenColor, m.sheenRoughness);
  bind(s);
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const float c = (static_cast<float>(i) + 0.5f) / 1000;
    sum += 2.0 * c * s.at(c).diffuseUnderMap().x * M_PI / 1000;
  }
  EXPECT_NEAR(core::baseDiffuseFactor(core::Scene{}, m), sum, 1e-3);
}

TEST(Layers, Hard14Reciprocity) {
  HardCase ways("reciprocity under clearcoat and sheen, relative above 1");
  std::mt19937 engine(10);
  std::uniform_real_distribution<float> u(0.05f, 1);
  for (int i = 0; i < 3000; ++i) {
    const Base& base = kBases[i % 2];  // rough and opaque
    Patch s = over(base, i % 3 ? u(engine) : 0, 0.2f + 0.8f * u(engine), i % 5 ? Vec3(u(engine)) : Vec3(0),
                   u(engine));
    bind(s);
    const Vec3 v = Patch::direction(u(engine), 6 * u(engine)), l = Patch::direction(u(engine), 6 * u(engine));
    const float forth = Bsdf(s.surface, v).eval(l, kLobeAll).x / l.z;
    const float back = Bsdf(s.surface, l).eval(v, kLobeAll).x / v.z;
    ASSERT_TRUE(ways.within(std::fabs(forth - back) / std::max(1.0f, forth), 1e-4)) << i;
  }
}

TEST(Layers, Hard14ReciprocityThroughACoatedInterface) {
  HardCase ways("reciprocity through coated glass, relative above 1");
  // Without the radiance's eta^2 (Walter 2007, section 5.2); the coat is crossed once either way.
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> u(0.2f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s =
        over({"", 0, 0.3f + 0.7f * u(engine), 1, true}, u(engine), u(engine), Vec3(u(engine)), u(engine));
    bind(s);
    const Vec3 v = Patch::direction(u(engine), 0);
    Vec3 l = Patch::direction(u(engine), 6 * u(engine));
    l.z = -l.z;
    const float forth = Bsdf(s.surface, v).eval(l, kLobeSpecular).x / -l.z;
    Surface behind = s.surface;
    behind.front = false;
    behind.ng = behind.ns = behind.point.extension->coatNormal = Vec3(0, 0, -1);
    const float back = Bsdf(behind, l).eval(v, kLobeSpecular).x / v.z;
    ASSERT_TRUE(ways.within(std::fabs(forth - 2.25f * back) / std::max(1.0f, forth), 1e-3)) << i;
  }
}

TEST(Layers, Hard14SampledDirectionsFollowTheDensity) {
  HardCase chance("chi-squared of directions, clearcoat and sheen", "-log10 p");
  constexpr int kCases = 2 * 3 * 4;
  for (float cosine : {0.8f, 0.3f}) {
    for (int layers = 1; layers <= 3; ++layers) {
      for (const Base& base : {kBases[0], kBases[1], kBases[3], kBases[4]}) {
        SCOPED_TRACE(std::string(base.name) + " layers " + std::to_string(layers) + " cosine " +
                     std::to_string(cosine));
        Base rough = base;
        rough.roughness = 0.6f;
        Patch s = over(rough, layers & 1 ? 1.0f : 0.0f, 0.6f, Vec3(layers & 2 ? 1.0f : 0.0f), 0.5f);
        s.extension().coatNormal = Patch::direction(0.95f, 1);
        bind(s);
        expectDensity(s.at(cosine, 0.7f), kLobeAll, kCases, chance);
      }
    }
  }
}

TEST(Layers, WeightIsValueOverDensity) {
  std::mt19937 engine(13);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 5000; ++i) {
    Patch s = over({"", u(engine), 0.3f + 0.7f * u(engine), u(engine), i % 2 == 0}, u(engine),
                   0.3f + 0.7f * u(engine), Vec3(u(engine)), u(engine));
    bind(s);
    const Bsdf bsdf = s.at(0.1f + 0.9f * u(engine), 6 * u(engine));
    const auto x = bsdf.sample(u(engine), {u(engine), u(engine)}, kLobeAll);
    if (!x || x->delta) continue;
    const Vec3 f = bsdf.eval(x->direction, kLobeAll);
    ASSERT_NEAR(x->weight.x * x->pdf, f.x, 1e-4f * f.x + 1e-6f);
    ASSERT_FLOAT_EQ(x->pdf, bsdf.pdf(x->direction, kLobeAll));
  }
}

TEST(Layers, AMirrorsWeightsAddUpToWhatItReflects) {
  // Coat and base smooth: what sample() gives in the mean is the sum of the branches.
  Patch s = over({"", 1, 0, 0, false}, 1, 0, Vec3(0), 0);
  bind(s);
  for (float cosine : kCosines) {
    const Bsdf bsdf = s.at(cosine);
    const Estimate e = sampledAlbedo(bsdf, kLobeSpecular, 20000, 14);
    ASSERT_TRUE(bsdf.coatReflection());
    EXPECT_EQ(bsdf.roughLobes(), 0u);
    EXPECT_NEAR(e.mean, bsdf.coatReflection()->weight.x + bsdf.deltaReflection().weight.x,
                3 * e.sigma + 1e-5);
  }
}

TEST(Layers, Hard11CoatRoughnessTowardsZeroJoinsTheMirror) {
  HardCase jump("direction at the threshold of clearcoat", "radians"),
      step("weight at the threshold of clearcoat");
  const float threshold = std::sqrt(kDeltaAlpha);
  for (float cosine : {1.0f, 0.5f, 0.1f}) {
    Patch smooth = overNothing(1, threshold * 0.99f, Vec3(0), 0),
          rough = overNothing(1, threshold * 1.01f, Vec3(0), 0);
    bind(smooth);
    bind(rough);
    const auto x = smooth.at(cosine).sample(0.5f, {0.5f, 0.3f}, kLobeAll),
               y = rough.at(cosine).sample(0.5f, {0.5f, 0.3f}, kLobeAll);
    ASSERT_TRUE(x && y);
    EXPECT_TRUE(x->delta);
    EXPECT_FALSE(y->delta);
    EXPECT_TRUE(jump.within(glm::length(x->direction - y->direction), 0.02)) << cosine;
    EXPECT_TRUE(step.near(x->weight.x, y->weight.x, 0.01)) << cosine;
  }
}

TEST(Layers, NoneIsTheBaseBitForBit) {
  std::mt19937 engine(15);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 1000; ++i) {
    const Base& base = kBases[i % 8];
    Patch with = over(base, 0, u(engine), Vec3(0), u(engine)),
          without = patch(base.metallic, base.roughness, base.transmission, base.closed);
    bind(with);
    bind(without);
    const float cosine = u(engine);
    const Bsdf a = with.at(cosine), b = without.at(cosine);
    const float uLobe = u(engine), x = u(engine), y = u(engine);
    const auto p = a.sample(uLobe, {x, y}, kLobeAll), q = b.sample(uLobe, {x, y}, kLobeAll);
    ASSERT_EQ(p.has_value(), q.has_value());
    if (!p) continue;
    EXPECT_EQ(p->direction, q->direction);
    EXPECT_EQ(p->weight, q->weight);
    EXPECT_EQ(a.eval(p->direction, kLobeAll), b.eval(p->direction, kLobeAll));
  }
}

}  // namespace
}  // namespace saccade::raytrace
