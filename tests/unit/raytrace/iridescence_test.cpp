// Thin films over metals, plastics and glass: KHR_materials_iridescence.
#include <gtest/gtest.h>

#include "core/scene/specular_albedo.h"
#include "core/scene/thin_film.h"
#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;
using core::ThinFilm;

const float kCosines[] = {1.0f, 0.7f, 0.3f, 0.05f};
const float kThickness[] = {50, 200, 400, 900};

Patch filmed(float metallic, float roughness, float transmission, bool closed, const ThinFilm& film) {
  Patch s = patch(metallic, roughness, transmission, closed);
  s.extension().film = film;
  return s;
}

/// Reflectance of the interfaces by ray optics, incoherent: what very thick films come to.
double incoherent(double r12, double r23) { return r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23); }

TEST(ThinFilm, NoThicknessIsTheBase) {
  for (float f0 : {0.0f, 0.04f, 0.5f, 0.95f}) {
    for (float cosine : kCosines) {
      const float schlicks = schlick(Vec3(f0), 1, cosine).x;
      EXPECT_NEAR(core::filmReflectance({1, 1.8f, 0}, Vec3(f0), cosine).x, schlicks, 1e-5);
      // And no jump on the way there.
      EXPECT_NEAR(core::filmReflectance({1, 1.8f, 1e-5f}, Vec3(f0), cosine).x, schlicks, 0.01);
    }
  }
}

TEST(ThinFilm, ThickFilmsLoseTheirFringes) {
  const double r12 = 0.3 * 0.3 / (2.3 * 2.3), root = std::sqrt(0.5), base = (1 + root) / (1 - root);
  const double r23 = std::pow((base - 1.3) / (base + 1.3), 2);
  const Vec3 r = core::filmReflectance({1, 1.3f, 20000}, Vec3(0.5f), 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(r[c], incoherent(r12, r23), 1e-3) << c;
}

TEST(ThinFilm, QuarterWaveOfTheGeometricMeanIndexQuenches) {
  // Index sqrt(n) on n, a quarter of 550 nm: no reflection at 550 nm, hence little of green.
  const float n = 1.69f, film = 1.3f;
  const float f0 = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
  const Vec3 quarter = core::filmReflectance({1, film, 550 / (4 * film)}, Vec3(f0), 1);
  const Vec3 half = core::filmReflectance({1, film, 550 / (2 * film)}, Vec3(f0), 1);
  EXPECT_LT(quarter.y, 0.12f * f0);
  EXPECT_GT(half.y, 0.7f * f0);
}

TEST(ThinFilm, StaysWithinZeroAndOneAndBelowItsBound) {
  for (float ior : {1.0f, 1.3f, 2.4f}) {
    for (float thickness = 0; thickness < 1500; thickness += 37) {
      for (float f0 : {0.0f, 0.04f, 0.6f, 1.0f}) {
        const ThinFilm film{0.8f, ior, thickness};
        const Vec3 bound = core::filmedF0(film, Vec3(f0), 1);
        for (int i = 0; i <= 50; ++i) {
          const float cosine = static_cast<float>(i) / 50;
          const Vec3 r = core::filmReflectance(film, Vec3(f0), cosine);
          for (int c = 0; c < 3; ++c) {
            ASSERT_TRUE(r[c] >= 0 && r[c] <= 1);
            const float plain = schlick(Vec3(f0), 1, cosine).x;
            const float mixed = film ? plain + film.weight * (r[c] - plain) : plain;
            // Between the angles at which the bound is taken, and grazing, where the weight is small.
            if (cosine >= 0.1f) {
              EXPECT_LE(mixed, schlick(bound, 1, cosine)[c] + 0.02f);
            }
          }
        }
      }
    }
  }
}

TEST(Iridescence, NoneIsThePlainLobeBitForBit) {
  std::mt19937 engine(15);
  std::uniform_real_distribution<float> u(0, 0.999f);
  for (int i = 0; i < 1000; ++i) {
    const ThinFilm none = i % 2 ? ThinFilm{0, 1.8f, 400} : ThinFilm{1, 1.8f, 0};
    const float metallic = u(engine), roughness = u(engine), transmission = u(engine);
    Patch with = filmed(metallic, roughness, transmission, i % 3 == 0, none),
          without = patch(metallic, roughness, transmission, i % 3 == 0);
    bind(with);
    bind(without);
    const float cosine = u(engine), uLobe = u(engine), x = u(engine), y = u(engine);
    const Bsdf a = with.at(cosine), b = without.at(cosine);
    const auto p = a.sample(uLobe, {x, y}, kLobeAll), q = b.sample(uLobe, {x, y}, kLobeAll);
    ASSERT_EQ(p.has_value(), q.has_value());
    if (!p) continue;
    EXPECT_EQ(p->direction, q->direction);
    EXPECT_EQ(p->weight, q->weight);
    EXPECT_EQ(a.eval(p->direction, kLobeAll), b.eval(p->direction, kLobeAll));
  }
}

TEST(Iridescence, Hard10FurnaceNeverExceedsOne) {
  HardCase furnace("white furnace, thin films");
  struct Kind {
    float metallic, transmission;
    bool closed;
  };
  for (const Kind& k :
       {Kind{1, 0, false}, Kind{0, 0, false}, Kind{0, 1, true}, Kind{0, 1, false}, Kind{0.4f, 0.5f, true}}) {
    for (float roughness : {0.0f, 0.3f, 1.0f}) {
      for (float cosine : kCosines) {
        for (float thickness : kThickness) {
          for (bool front : {true, false}) {
            if (!front && !k.closed) continue;
            Patch s = filmed(k.metallic, roughness, k.transmission, k.closed, {1, 1.8f, thickness});
            s.surface.front = front;
            bind(s);
            const Estimate e = sampledAlbedo(s.at(cosine), kLobeAll, 4000, 8);
            EXPECT_TRUE(furnace.within(e.mean - 1, 3.5 * e.sigma + 2e-3))
                << k.metallic << " " << k.transmission << " " << roughness << " " << cosine << " "
                << thickness;
          }
        }
      }
    }
  }
}

TEST(Iridescence, Hard10SmoothGlassLosesNothing) {
  HardCase lost("white furnace, smooth glass under a film: reflected and transmitted sum to 1");
  for (bool closed : {true, false}) {
    for (bool front : {true, false}) {
      for (float cosine : kCosines) {
        Patch s = filmed(0, 0, 1, closed, {1, 1.8f, 400});
        s.surface.front = front;
        bind(s);
        const Bsdf bsdf = s.at(cosine);
        const auto through = bsdf.deltaTransmission();
        Vec3 sum = bsdf.deltaReflection().weight;
        if (through) sum += through->weight;
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(lost.near(sum[c], 1, 1e-6)) << cosine;
        EXPECT_EQ(through.has_value(),
                  !closed || front || cosine > std::sqrt(1 - 1 / 2.25f));  // total reflection
      }
    }
  }
}

TEST(Iridescence, Hard14Reciprocity) {
  HardCase ways("reciprocity, thin films, relative above 1");
  std::mt19937 engine(10);
  std::uniform_real_distribution<float> u(0.05f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s = filmed(i % 3 == 0 ? 1.0f : 0.3f, 0.1f + 0.9f * u(engine), 0, false,
                     {u(engine), 1 + u(engine), 900 * u(engine)});
    bind(s);
    const Vec3 v = Patch::direction(u(engine), 0), l = Patch::direction(u(engine), 6 * u(engine));
    const float forth = Bsdf(s.surface, v).eval(l, kLobeAll).x / l.z;
    const float back = Bsdf(s.surface, l).eval(v, kLobeAll).x / v.z;
    ASSERT_TRUE(ways.within(std::fabs(forth - back) / std::max(1.0f, forth), 1e-4));
  }
}

TEST(Iridescence, Hard14ReciprocityThroughAnInterface) {
  HardCase ways("reciprocity through filmed glass, relative above 1");
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> u(0.2f, 1);
  for (int i = 0; i < 2000; ++i) {
    Patch s = filmed(0, 0.3f + 0.7f * u(engine), 1, true, {u(engine), 1 + u(engine), 900 * u(engine)});
    bind(s);
    const Vec3 v = Patch::direction(u(engine), 0);
    Vec3 l = Patch::direction(u(engine), 6 * u(engine));
    l.z = -l.z;
    const Vec3 forth = Bsdf(s.surface, v).eval(l, kLobeSpecular) / -l.z;
    Surface behind = s.surface;
    behind.front = false;
    behind.ng = behind.ns = Vec3(0, 0, -1);
    const Vec3 back = Bsdf(behind, l).eval(v, kLobeSpecular) / v.z;
    for (int c = 0; c < 3; ++c)
      ASSERT_TRUE(ways.within(std::fabs(forth[c] - 2.25f * back[c]) / std::max(1.0f, forth[c]), 2e-3)) << i;
  }
}

TEST(Iridescence, Hard14SampledDirectionsFollowTheDensity) {
  HardCase chance("chi-squared of directions, thin films", "-log10 p");
  constexpr int kCases = 2 * 4;
  for (float cosine : {0.9f, 0.3f}) {
    const ThinFilm film{1, 1.6f, 450};
    Patch metal = filmed(1, 0.6f, 0, false, film), plastic = filmed(0, 0.6f, 0, false, film),
          glass = filmed(0, 0.6f, 1, true, film), sheet = filmed(0, 0.6f, 1, false, film);
    for (Patch* s : {&metal, &plastic, &glass, &sheet}) {
      bind(*s);
      expectDensity(s->at(cosine, 0.5f), kLobeAll, kCases, chance);
    }
  }
}

/// A film, a coat and sheen over a brushed base.
Patch everything(float metallic) {
  Patch s = filmed(metallic, 0.6f, 0, false, {0.8f, 1.6f, 450});
  ExtensionPoint& e = s.extension();
  e.clearcoat = 0.7f;
  e.clearcoatRoughness = 0.6f;
  e.sheenColor = Vec3(0.5f, 0.3f, 0.1f);
  e.sheenRoughness = 0.5f;
  e.anisotropy = 0.6f;
  e.tangent = Vec3(1, 0, 0);
  return s;
}

TEST(Iridescence, Hard10UnderLayersAndBrushedStaysWithinTheFurnace) {
  HardCase furnace("white furnace, film, coat and sheen over a brushed base");
  for (float metallic : {0.0f, 1.0f}) {
    for (float cosine : {0.8f, 0.3f}) {
      Patch s = everything(metallic);
      bind(s);
      const Estimate albedo = sampledAlbedo(s.at(cosine, 0.4f), kLobeAll, 40000, 9);
      EXPECT_TRUE(furnace.within(albedo.mean - 1, 3 * albedo.sigma + 2e-3)) << metallic << " " << cosine;
    }
  }
}

TEST(Iridescence, Hard14UnderLayersAndBrushedFollowsItsDensity) {
  constexpr int kCases = 4;
  HardCase chance("chi-squared of directions, film, coat and sheen over a brushed base", "-log10 p");
  for (float metallic : {0.0f, 1.0f}) {
    for (float cosine : {0.8f, 0.3f}) {
      Patch s = everything(metallic);
      bind(s);
      expectDensity(s.at(cosine, 0.4f), kLobeAll, kCases, chance);
    }
  }
}

}  // namespace
}  // namespace saccade::raytrace
