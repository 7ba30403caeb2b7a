// Numerics 15 and 19 of the hard cases: opposite and grazing directions, and random numbers of exactly 0 and
// 1, for every kind of lobe.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard_case.h"
#include "tests/unit/raytrace/bsdf_patch.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

struct Base {
  float metallic, transmission;
  bool closed;
  float ior;
};
const Base kBases[] = {{1, 0, false, 1.5f},     {0, 0, false, 1.5f}, {0, 1, true, 1.5f},
                       {0, 1, false, 1.5f},     {0, 1, true, 1},     {0.2f, 0.7f, true, 1.0005f},
                       {0.3f, 0.4f, true, 1.5f}};
enum class Over { nothing, coat, sheen, both, film, brushed, ward };
constexpr Over kOvers[] = {Over::nothing, Over::coat,    Over::sheen, Over::both,
                           Over::film,    Over::brushed, Over::ward};

Patch lobe(const Base& base, Over over, float roughness, bool front) {
  Patch s = patch(base.metallic, roughness, base.transmission, base.closed, base.ior);
  s.surface.front = front;
  s.material.doubleSided = true;
  if (over == Over::nothing) return s;
  ExtensionPoint& e = s.extension();
  e.tangent = Vec3(1, 0, 0);
  if (over == Over::coat || over == Over::both) e.clearcoat = 1, e.clearcoatRoughness = roughness;
  if (over == Over::sheen || over == Over::both) e.sheenColor = Vec3(1), e.sheenRoughness = roughness;
  if (over == Over::film) e.film = {1, 1.8f, 400};
  if (over == Over::brushed) e.anisotropy = 0.9f;
  if (over == Over::ward) e.ward = Ward{Vec3(0.7f), std::max(1e-3f, roughness), 1};
  return s;
}

/// Calls visit(bsdf, v) for every kind of lobe, smooth and rough, from both sides, up to grazing views.
template <class Visit>
void forEachLobe(Visit&& visit) {
  for (const Base& base : kBases) {
    for (const Over over : kOvers) {
      for (const float roughness : {0.0f, 0.05f, 0.5f, 1.0f}) {
        for (const bool front : {true, false}) {
          Patch s = lobe(base, over, roughness, front);
          bind(s);
          s.material.doubleSided = true;
          for (const float cosine : {1.0f, 0.3f, 1e-7f, 0.0f}) {
            const Vec3 v = Patch::direction(cosine, 0);
            visit(Bsdf(s.surface, v), v);
          }
        }
      }
    }
  }
}

bool sound(const Vec3& f) { return std::isfinite(f.x + f.y + f.z) && f.x >= 0 && f.y >= 0 && f.z >= 0; }
bool sound(float p) { return std::isfinite(p) && p >= 0; }

TEST(BsdfExtremes, Hard15OppositeAndGrazingDirectionsStayFinite) {
  int unsound = 0, asked = 0;
  forEachLobe([&](const Bsdf& bsdf, const Vec3& v) {
    for (const Vec3& wi :
         {-v, v, Vec3(-v.x, 0, v.z), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(-1, 0, 1e-6f), Vec3(0, 0, -1)}) {
      ++asked;
      unsound += !sound(bsdf.eval(wi, kLobeAll)) || !sound(bsdf.pdf(wi, kLobeAll));
    }
  });
  EXPECT_GT(asked, 10000);
  EXPECT_TRUE(HardCase::counting(
                  "half vector of opposite and grazing directions: values not finite or negative", "values")
                  .within(unsound, 0));
}

TEST(BsdfExtremes, Hard19RandomNumbersOfZeroAndOneGiveSoundSamples) {
  int unsound = 0, drawn = 0;
  double offUnit = 0;
  forEachLobe([&](const Bsdf& bsdf, const Vec3&) {
    for (const float uLobe : {0.0f, 0.5f, 0.99999994f, 1.0f}) {
      for (const float x : {0.0f, 0.5f, 0.99999994f, 1.0f}) {
        for (const float y : {0.0f, 0.5f, 0.99999994f, 1.0f}) {
          const auto s = bsdf.sample(uLobe, {x, y}, kLobeAll);
          if (!s) continue;
          ++drawn;
          const bool good = sound(s->weight) && sound(s->pdf);
          unsound += !good;
          const double off = std::fabs(glm::length(s->direction) - 1);
          if (!(off <= offUnit)) offUnit = off;  // keeps a NaN
        }
      }
    }
  });
  EXPECT_GT(drawn, 50000);
  EXPECT_TRUE(
      HardCase::counting("u of 0 and 1: samples not finite or negative", "samples").within(unsound, 0));
  EXPECT_TRUE(HardCase("u of 0 and 1: directions off unit length").within(offUnit, 1e-4));
}

}  // namespace
}  // namespace saccade::raytrace
