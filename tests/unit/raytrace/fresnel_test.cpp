// Numerics 13 of the hard cases: Fresnel's reflectance against the textbook in double precision.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/microfacet.h"
#include "tests/hard_case.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;

/// By Snell's law and Fresnel's two amplitudes.
double textbook(double cosI, double eta) {
  const double sinT = std::sqrt(std::max(0.0, 1 - cosI * cosI)) / eta;
  if (sinT >= 1) return 1;
  const double cosT = std::sqrt(1 - sinT * sinT);
  const double s = (cosI - eta * cosT) / (cosI + eta * cosT);
  const double p = (eta * cosI - cosT) / (eta * cosI + cosT);
  return 0.5 * (s * s + p * p);
}

/// How far R moves when its arguments do: what rounding may cost.
double moved(double cosI, double eta, double byCos, double byEta) {
  return std::fabs(textbook(cosI + byCos, eta) - textbook(cosI - byCos, eta)) +
         std::fabs(textbook(cosI, eta + byEta) - textbook(cosI, eta - byEta));
}
constexpr double kUlp = 0x1p-24;  ///< half a float's step, relative

/// Of eta^2 - 1 + cos^2, as a change of eta; and of two quotients of three roundings each, squared, and their
/// sum.
double rounding(double cosI, double eta) {
  return moved(cosI, eta, 0, 2 * kUlp * (1 + eta * eta) / eta) + 8 * kUlp;
}

const float kIndices[] = {1.0003f, 1.1f, 1.33f, 1.5f, 2.42f, 4};

TEST(Fresnel, Hard13NormalIncidenceAndGrazing) {
  HardCase normal("reflectance at normal incidence"), grazing("reflectance at grazing incidence is 1");
  for (const float ior : kIndices) {
    for (const float eta : {ior, 1 / ior}) {
      const double root = (static_cast<double>(eta) - 1) / (static_cast<double>(eta) + 1);
      EXPECT_TRUE(normal.near(fresnelDielectric(1, eta), root * root, 1e-6)) << eta;
      EXPECT_TRUE(grazing.near(fresnelDielectric(0, eta), 1, 0)) << eta;
    }
  }
}

TEST(Fresnel, Hard13EqualsTheTextbookAtEveryAngle) {
  HardCase off("reflectance of dielectrics at every angle, both sides");
  for (const float ior : kIndices) {
    for (const float eta : {ior, 1 / ior}) {
      for (int i = 0; i <= 10000; ++i) {
        const float c = static_cast<float>(i) / 10000;
        EXPECT_TRUE(off.near(fresnelDielectric(c, eta), textbook(c, eta), rounding(c, eta)))
            << eta << " at " << c;
      }
    }
  }
}

TEST(Fresnel, Hard13EqualIndicesReflectNothing) {
  HardCase nothing("reflectance of equal indices is 0");
  for (int i = 1; i <= 1000; ++i)
    EXPECT_TRUE(nothing.near(fresnelDielectric(static_cast<float>(i) / 1000, 1), 0, 1e-6)) << i;
}

TEST(Fresnel, Hard13TotalReflectionBeginsWithoutAJump) {
  // Below the critical angle 1 - R grows as 2 (1 + 1/eta^2) g / cos, g^2 = eta^2 - 1 + cos^2, whose rounding
  // is that of numbers about 1.
  HardCase jump("step of the reflectance at the critical angle"), total("total reflection is 1");
  for (const float ior : {1.1f, 1.33f, 1.5f, 2.42f, 4.0f}) {
    const float eta = 1 / ior;
    float c = std::sqrt(1 - eta * eta) * (1 - 1e-5f);
    float before = fresnelDielectric(c, eta);
    EXPECT_TRUE(total.near(before, 1, 0)) << ior;
    while (before == 1) before = fresnelDielectric(c = std::nextafter(c, 2.0f), eta);
    const double allowed = 2 * (1 + 1 / (double{eta} * eta)) * std::sqrt(4 * 0x1p-24) / c;
    EXPECT_TRUE(jump.near(before, 1, allowed)) << ior;
  }
}

TEST(Fresnel, Hard13BothSidesReflectAlikeAlongOnePath) {
  HardCase stokes("the same from both sides along one path (Stokes)");
  for (const float ior : kIndices) {
    for (const float c : {0.1f, 0.4f, 0.7f, 0.95f}) {
      const float sinT = std::sqrt(1 - c * c) / ior, cosT = std::sqrt(1 - sinT * sinT);
      const double allowed =
          rounding(c, ior) + rounding(cosT, 1 / ior) + moved(cosT, 1 / ior, 4 * kUlp / cosT, kUlp);
      EXPECT_TRUE(stokes.near(fresnelDielectric(c, ior), fresnelDielectric(cosT, 1 / ior), allowed))
          << ior << " at " << c;
    }
  }
}

}  // namespace
}  // namespace saccade::raytrace
