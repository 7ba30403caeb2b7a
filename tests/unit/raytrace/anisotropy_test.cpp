// Anisotropic GGX: KHR_materials_anisotropy.
#include <gtest/gtest.h>

#include "core/scene/specular_albedo.h"
#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

const float kCosines[] = {1.0f, 0.7f, 0.3f, 0.05f};

Patch brushed(float metallic, float roughness, float strength, float transmission = 0, bool closed = false) {
  Patch s = patch(metallic, roughness, transmission, closed);
  s.extension().anisotropy = strength;
  s.extension().tangent = Vec3(1, 0, 0);
  return s;
}

TEST(Anisotropy, NoneIsTheIsotropicLobeBitForBit) {
  std::mt19937 engine(15);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 1000; ++i) {
    const float metallic = u(engine), roughness = u(engine), transmission = u(engine);
    Patch with = brushed(metallic, roughness, 0, transmission, i % 2),
          without = patch(metallic, roughness, transmission, i % 2);
    with.extension().tangent = Vec3(0);  // what makeSurface gives: the same basis
    bind(with);
    bind(without);
    const float cosine = u(engine), azimuth = 6 * u(engine), uLobe = u(engine), x = u(engine), y = u(engine);
    const Bsdf a = with.at(cosine, azimuth), b = without.at(cosine, azimuth);
    const auto p = a.sample(uLobe, {x, y}, kLobeAll), q = b.sample(uLobe, {x, y}, kLobeAll);
    ASSERT_EQ(p.has_value(), q.has_value());
    if (!p) continue;
    EXPECT_EQ(p->direction, q->direction);
    EXPECT_EQ(p->weight, q->weight);
    EXPECT_EQ(a.eval(p->direction, kLobeAll), b.eval(p->direction, kLobeAll));
  }
}

TEST(Anisotropy, EqualAlphasAreIsotropicByTheOtherFormulas) {
  // A hair's breadth of difference takes the anisotropic functions.
  std::mt19937 engine(16);
  std::uniform_real_distribution<float> u(0.1f, 1);
  for (int i = 0; i < 1000; ++i) {
    const float a = u(engine);
    const Ggx round{a, a}, nearly{a, std::nextafter(a, 2.0f)};
    const Vec3 v = Patch::direction(u(engine), 6 * u(engine));
    EXPECT_NEAR(round.d(v), nearly.d(v), 1e-5f * round.d(v));
    EXPECT_NEAR(round.lambda(v), nearly.lambda(v), 1e-5f * (1 + round.lambda(v)));
  }
}

TEST(Anisotropy, DensityOfFacetsProjectsToOne) {
  for (const Ggx& ggx : {Ggx{0.5f, 0.2f}, Ggx{1, 0.1f}, Ggx{0.3f, 0.3f}}) {
    double sum = 0;
    constexpr int kSteps = 800;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const float z = (static_cast<float>(i) + 0.5f) / kSteps,
                    phi = 2 * core::kPi * (static_cast<float>(j) + 0.5f) / kSteps;
        sum += ggx.d(Patch::direction(z, phi)) * z * 2 * M_PI / (kSteps * kSteps);
      }
    }
    EXPECT_NEAR(sum, 1, 3e-3);
  }
}

TEST(Anisotropy, StretchesTheHighlightAcrossNothingButTheTangent) {
  // At normal incidence the density towards the tangent's plane is that of the wide alpha.
  Patch s = brushed(1, 0.4f, 1);  // alpha 1 along x, 0.16 along y
  bind(s);
  const Bsdf bsdf = s.at(1);
  EXPECT_GT(bsdf.eval(Patch::direction(0.7f, 0), kLobeAll).x,
            10 * bsdf.eval(Patch::direction(0.7f, core::kPi / 2), kLobeAll).x);
}

TEST(Anisotropy, Hard10FurnaceNeverExceedsOne) {
  HardCase furnace("white furnace, anisotropic GGX");
  for (float metallic : {0.0f, 1.0f}) {
    for (float transmission : {0.0f, 1.0f}) {
      for (float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
        for (float strength : {0.3f, 0.7f, 1.0f}) {
          for (float cosine : kCosines) {
            for (float azimuth : {0.0f, 0.8f, core::kPi / 2}) {
              Patch s = brushed(metallic, roughness, strength, transmission, true);
              bind(s);
              const Estimate e = sampledAlbedo(s.at(cosine, azimuth), kLobeAll,
                                               metallic + transmission > 0 ? 2000 : 30000, 8);
              EXPECT_TRUE(furnace.within(e.mean - 1, 3 * e.sigma + 2e-3))
                  << metallic << " " << transmission << " " << roughness << " " << strength << " " << cosine
                  << " " << azimuth;
            }
          }
        }
      }
    }
  }
}

TEST(Anisotropy, Hard14Reciprocity) {
  HardCase ways("reciprocity, anisotropic GGX, relative above 1");
  std::mt19937 engine(10);
  std::uniform_real_distribution<float> u(0.05f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s = brushed(i % 3 == 0 ? 1.0f : 0.3f, 0.1f + 0.9f * u(engine), u(engine));
    bind(s);
    const Vec3 v = Patch::direction(u(engine), 6 * u(engine)), l = Patch::direction(u(engine), 6 * u(engine));
    const float forth = Bsdf(s.surface, v).eval(l, kLobeAll).x / l.z;
    const float back = Bsdf(s.surface, l).eval(v, kLobeAll).x / v.z;
    ASSERT_TRUE(ways.within(std::fabs(forth - back) / std::max(1.0f, forth), 1e-4));
  }
}

TEST(Anisotropy, Hard14SampledDirectionsFollowTheDensity) {
  HardCase chance("chi-squared of directions, anisotropic GGX", "-log10 p");
  constexpr int kCases = 2 * 2 * 4;
  for (float cosine : {0.9f, 0.3f}) {
    for (float azimuth : {0.5f, 1.5f}) {
      Patch metal = brushed(1, 0.6f, 0.7f), plastic = brushed(0, 0.6f, 0.7f),
            glass = brushed(0, 0.6f, 0.7f, 1, true), sheet = brushed(0, 0.6f, 0.7f, 1, false);
      for (Patch* s : {&metal, &plastic, &glass, &sheet}) {
        bind(*s);
        expectDensity(s->at(cosine, azimuth), kLobeAll, kCases, chance);
      }
    }
  }
}

TEST(Anisotropy, WeightIsValueOverDensity) {
  std::mt19937 engine(13);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 3000; ++i) {
    Patch s =
        brushed(i % 2 ? 1.0f : 0.0f, 0.3f + 0.7f * u(engine), u(engine), i % 3 ? 0.5f : 0.0f, i % 5 != 0);
    bind(s);
    const Bsdf bsdf = s.at(0.1f + 0.9f * u(engine), 6 * u(engine));
    const auto x = bsdf.sample(u(engine), {u(engine), u(engine)}, kLobeAll);
    if (!x || x->pdf < 1e-3f) continue;
    ASSERT_NEAR(x->weight.x * x->pdf, bsdf.eval(x->direction, kLobeAll).x,
                2e-2f * x->weight.x * x->pdf + 1e-4f);
  }
}

TEST(Anisotropy, FramesFollowTheTangentAndFallBackWithoutOne) {
  const Vec3 n = glm::normalize(Vec3(1, 2, 3));
  const Frame f(n, Vec3(1, 0, 0));
  EXPECT_NEAR(glm::dot(f.t, n), 0, 1e-6);
  EXPECT_GT(f.t.x, 0);
  EXPECT_NEAR(glm::dot(glm::cross(f.t, f.b), f.n), 1, 1e-6);
  EXPECT_EQ(Frame(n, Vec3(0)).t, Frame(n).t);
  EXPECT_EQ(Frame(n, n).t, Frame(n).t);
}

}  // namespace
}  // namespace saccade::raytrace
