// Ward's lobe in its bounded form.
#include "raytrace/ward.h"

#include <gtest/gtest.h>

#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

const float kCosines[] = {1.0f, 0.7f, 0.3f, 0.05f};

Patch ward(const Vec3& diffuse, const Vec3& specular, float alphaX, float alphaY) {
  Patch s = patch(0, 1, 0, false);
  s.surface.point.baseColor = diffuse;
  s.extension().ward = Ward{specular, alphaX, alphaY};
  s.extension().tangent = Vec3(1, 0, 0);
  return s;
}

TEST(Ward, IsWards1992LobeAtNormalIncidence) {
  const Ward lobe{Vec3(0.5f), 0.2f, 0.1f};
  // rho_s / (4 pi ax ay) at l = v = n.
  EXPECT_NEAR(lobe.eval({0, 0, 1}, {0, 0, 1}).x, 0.5f / (4 * core::kPi * 0.2f * 0.1f), 1e-4);
}

TEST(Ward, Hard12AlbedoIsBoundedUpTo89Point9Degrees) {
  // Duer's form without the bound grows as 1 / cos there; this one stays below rho_s.
  HardCase furnace("white furnace, Ward to 89.9 degrees");
  for (float alpha : {0.02f, 0.1f, 0.3f, 0.6f}) {
    for (float ratio : {1.0f, 0.2f}) {
      for (float degrees : {0.0f, 45.0f, 80.0f, 89.0f, 89.9f}) {
        for (float azimuth : {0.0f, 0.8f, core::kPi / 2}) {
          Patch s = ward(Vec3(0), Vec3(1), alpha, alpha * ratio);
          bind(s);
          const float cosine = std::cos(degrees * core::kPi / 180);
          const Estimate e = sampledAlbedo(s.at(cosine, azimuth), kLobeAll, 20000, 7);
          EXPECT_TRUE(furnace.within(e.mean - 1, 4 * e.sigma)) << alpha << " " << ratio << " " << degrees;
          EXPECT_GT(e.mean, 0.2) << alpha << " " << ratio << " " << degrees;
        }
      }
    }
  }
}

TEST(Ward, Hard10OverLambertStaysWithinTheFurnace) {
  HardCase furnace("white furnace, Ward over Lambert");
  for (float alpha : {0.001f, 0.05f, 0.3f}) {
    for (float cosine : kCosines) {
      Patch s = ward(Vec3(0.6f), Vec3(0.4f), alpha, 2 * alpha);
      bind(s);
      const Estimate e = sampledAlbedo(s.at(cosine, 0.3f), kLobeAll, 20000, 8);
      EXPECT_TRUE(furnace.within(e.mean - 1, 4 * e.sigma)) << alpha << " " << cosine;
      EXPECT_GT(e.mean, 0.6 - 4 * e.sigma);
      EXPECT_FLOAT_EQ(s.at(cosine).diffuseUnderMap().x, 0.6f / core::kPi);
    }
  }
}

TEST(Ward, Hard14Reciprocity) {
  HardCase ways("reciprocity, Ward, relative above 1");
  std::mt19937 engine(10);
  std::uniform_real_distribution<float> u(0.02f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s = ward(Vec3(0.3f), Vec3(0.5f), u(engine), u(engine));
    bind(s);
    const Vec3 v = Patch::direction(u(engine), 6 * u(engine)), l = Patch::direction(u(engine), 6 * u(engine));
    const float forth = Bsdf(s.surface, v).eval(l, kLobeAll).x / l.z;
    const float back = Bsdf(s.surface, l).eval(v, kLobeAll).x / v.z;
    ASSERT_TRUE(ways.within(std::fabs(forth - back) / std::max(1.0f, forth), 1e-4));
  }
}

TEST(Ward, Hard14SampledDirectionsFollowTheDensity) {
  HardCase chance("chi-squared of directions, Ward", "-log10 p");
  constexpr int kCases = 3 * 2 * 2;
  for (float cosine : {0.95f, 0.6f, 0.2f}) {
    for (float azimuth : {0.0f, 1.0f}) {
      Patch alone = ward(Vec3(0), Vec3(1), 0.5f, 0.25f), over = ward(Vec3(0.5f), Vec3(0.5f), 0.3f, 0.3f);
      bind(alone);
      bind(over);
      expectDensity(alone.at(cosine, azimuth), kLobeAll, kCases, chance);
      expectDensity(over.at(cosine, azimuth), kLobeAll, kCases, chance);
    }
  }
}

TEST(Ward, WeightIsValueOverDensity) {
  std::mt19937 engine(13);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 3000; ++i) {
    Patch s = ward(Vec3(i % 2 ? 0.5f : 0.0f), Vec3(0.5f), 0.1f + 0.5f * u(engine), 0.1f + 0.5f * u(engine));
    bind(s);
    const Bsdf bsdf = s.at(0.05f + 0.9f * u(engine), 6 * u(engine));
    const auto x = bsdf.sample(u(engine), {u(engine), u(engine)}, kLobeAll);
    if (!x) continue;
    const Vec3 f = bsdf.eval(x->direction, kLobeAll);
    ASSERT_NEAR(x->weight.x * x->pdf, f.x, 2e-3f * f.x + 1e-5f);
  }
}

TEST(Ward, Hard11AlphaTowardsZeroJoinsTheMirror) {
  HardCase jump("direction at the threshold of Ward", "radians"), step("weight at the threshold of Ward");
  for (float cosine : {1.0f, 0.5f, 0.1f}) {
    Patch smooth = ward(Vec3(0), Vec3(0.7f), kDeltaAlpha * 0.9f, kDeltaAlpha * 0.9f),
          rough = ward(Vec3(0), Vec3(0.7f), kDeltaAlpha * 1.1f, kDeltaAlpha * 1.1f);
    bind(smooth);
    bind(rough);
    const auto x = smooth.at(cosine).sample(0.5f, {0.5f, 0.3f}, kLobeAll),
               y = rough.at(cosine).sample(0.5f, {0.5f, 0.3f}, kLobeAll);
    ASSERT_TRUE(x && y);
    EXPECT_TRUE(x->delta);
    EXPECT_FALSE(y->delta);
    EXPECT_TRUE(jump.within(glm::length(x->direction - y->direction), 0.02)) << cosine;
    EXPECT_TRUE(step.near(x->weight.x, y->weight.x, 0.02)) << cosine;
  }
}

}  // namespace
}  // namespace saccade::raytrace
