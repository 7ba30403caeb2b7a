// The albedo table against closed forms and against a direct integral of the BRDF.
#include "core/scene/specular_albedo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade::core {
namespace {

/// E(cosV) for F0, F90 = 1 by brute force over light directions: an independent route to the table's values.
double albedoByDirections(double cosView, double roughness, double f0) {
  const double alpha = roughness * roughness, alpha2 = alpha * alpha;
  const double sinView = std::sqrt(1 - cosView * cosView);
  const int polar = 500, azimuth = 250;
  double sum = 0;
  for (int i = 0; i < polar; ++i) {
    const double cosLight = (i + 0.5) / polar, sinLight = std::sqrt(1 - cosLight * cosLight);
    for (int j = 0; j < azimuth; ++j) {
      const double phi = (j + 0.5) / azimuth * M_PI;
      const double hx = sinView + sinLight * std::cos(phi), hy = sinLight * std::sin(phi),
                   hz = cosView + cosLight;
      const double length = std::sqrt(hx * hx + hy * hy + hz * hz);
      const double cosNormal = hz / length, cosHalf = (sinView * hx + cosView * hz) / length;
      const double d = cosNormal * cosNormal * (alpha2 - 1) + 1;
      const double distribution = alpha2 / (M_PI * d * d);
      const auto smith = [&](double a, double b) { return a * std::sqrt(alpha2 + (1 - alpha2) * b * b); };
      const double visibility = 0.5 / (smith(cosView, cosLight) + smith(cosLight, cosView));
      const double fresnel = f0 + (1 - f0) * std::pow(1 - cosHalf, 5);
      sum += distribution * visibility * fresnel * cosLight;
    }
  }
  return sum * 2 * M_PI / (static_cast<double>(polar) * azimuth);
}

TEST(SpecularAlbedo, MirrorIsSchlick) {
  for (float c = 0.02f; c <= 1; c += 0.07f) {
    const AlbedoPair e = directionalAlbedo(c, 0);
    const float grazing = std::pow(1 - c, 5.0f);
    EXPECT_NEAR(e.bias, grazing, 1e-3f) << c;
    EXPECT_NEAR(e.scale, 1 - grazing, 1e-3f) << c;
  }
  EXPECT_NEAR(meanAlbedo(0).bias, 1.0 / 21, 2e-4);
  EXPECT_NEAR(meanAlbedo(0).scale, 20.0 / 21, 2e-4);
}

TEST(SpecularAlbedo, EqualsTheIntegralOfTheBrdf) {
  for (const float roughness : {0.4f, 0.7f, 1.0f}) {
    for (const float c : {0.15f, 0.5f, 1.0f}) {
      const AlbedoPair e = directionalAlbedo(c, roughness);
      EXPECT_NEAR(0.04f * e.scale + e.bias, albedoByDirections(c, roughness, 0.04), 3e-3)
          << roughness << ' ' << c;
      EXPECT_NEAR(e.scale + e.bias, albedoByDirections(c, roughness, 1), 4e-3) << roughness << ' ' << c;
    }
  }
}

TEST(SpecularAlbedo, NeverAboveOneNorBelowZero) {
  for (float roughness = 0; roughness <= 1; roughness += 0.05f) {
    for (float c = 0; c <= 1; c += 0.02f) {
      const AlbedoPair e = directionalAlbedo(c, roughness);
      EXPECT_GE(e.scale, 0);
      EXPECT_GE(e.bias, 0);
      EXPECT_LE(e.scale + e.bias, 1.0001f) << roughness << ' ' << c;
    }
  }
}

TEST(SpecularAlbedo, SingleScatterLosesEnergyWhenRough) {
  const AlbedoPair rough = directionalAlbedo(1, 1);
  EXPECT_NEAR(rough.scale + rough.bias, 0.31, 0.01);  // known value at alpha = 1, normal incidence
}

TEST(SpecularAlbedo, MeanIsTheCosineMeanOfDirections) {
  for (const float roughness : {0.1f, 0.5f, 0.9f}) {
    double scale = 0, bias = 0;
    const int steps = 4000;
    for (int i = 0; i < steps; ++i) {
      const float c = (static_cast<float>(i) + 0.5f) / steps;
      scale += 2.0 * directionalAlbedo(c, roughness).scale * c / steps;
      bias += 2.0 * directionalAlbedo(c, roughness).bias * c / steps;
    }
    EXPECT_NEAR(meanAlbedo(roughness).scale, scale, 1e-4);
    EXPECT_NEAR(meanAlbedo(roughness).bias, bias, 1e-4);
  }
}

TEST(SpecularAlbedo, DielectricLimits) {
  Material m;
  m.metallic = 0;
  EXPECT_NEAR(dielectricF0(m).x, 0.04f, 1e-6f);
  EXPECT_EQ(dielectricF90(dielectricF0(m), 1), 1);
  m.ior = 1;
  EXPECT_EQ(dielectricF90(dielectricF0(m), 1), 0);
  m.ior = 1.5f;
  m.specularColor = Vec3(0);
  EXPECT_EQ(baseDiffuseFactor(Scene{}, m), 1);
  m.specularColor = Vec3(1);
  m.specular = 0.5f;
  EXPECT_EQ(dielectricF90(dielectricF0(m), 0.5f), 0.5f);
  m.specular = 1;
  m.roughness = 0.5f;
  EXPECT_NEAR(baseDiffuseFactor(Scene{}, m), 1 - 0.04f * meanAlbedo(0.5f).scale - meanAlbedo(0.5f).bias,
              1e-6f);
  m.unlit = true;
  EXPECT_EQ(baseDiffuseFactor(Scene{}, m), 1);
}

}  // namespace
}  // namespace saccade::core
