// One surface point to try scattering on: furnace, and the chi-squared test of directions against pdf().
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "raytrace/bsdf.h"
#include "tests/hard_case.h"

namespace saccade::tests {

using namespace raytrace;

struct Patch {
  CompiledMaterial material;
  Surface surface;
  /// Seen under that cosine, from that azimuth (radians).
  Bsdf at(float cosView, float azimuth = 0) const { return Bsdf(surface, direction(cosView, azimuth)); }
  static Vec3 direction(float cosine, float azimuth) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
  }
  ExtensionPoint& extension() {
    if (!surface.point.extension) surface.point.extension.emplace();
    return *surface.point.extension;
  }
};

/// A flat surface, normal +z. `dielectric` 0.04 = index 1.5.
inline Patch patch(float metallic, float roughness, float transmission, bool closed, float ior = 1.5f) {
  Patch s;
  s.surface.ng = s.surface.ns = Vec3(0, 0, 1);
  s.surface.closed = closed;
  MaterialPoint& p = s.surface.point;
  p.baseColor = Vec3(1);
  p.metallic = metallic;
  p.roughness = roughness;
  p.transmission = transmission;
  p.ior = ior;
  p.dielectricF0 = Vec3((ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1)));
  s.surface.material = nullptr;
  return s;
}
/// The surface points at the material, which must not move.
inline void bind(Patch& s) {
  s.material.transmission = s.surface.point.transmission;
  s.surface.material = &s.material;
}

struct Estimate {
  double mean = 0, sigma = 0;
};
/// Albedo by sampling, with the error of the mean.
inline Estimate sampledAlbedo(const Bsdf& bsdf, unsigned lobes, int n, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> u(0, 1);
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const float uLobe = std::min(u(engine), 0.99999994f);
    const Vec2 uv(std::min(u(engine), 0.99999994f), std::min(u(engine), 0.99999994f));
    const auto s = bsdf.sample(uLobe, uv, lobes);
    const double w = s ? s->weight.x : 0;
    sum += w;
    squares += w * w;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

/// Probability that chi-squared with so many degrees of freedom exceeds x (Wilson and Hilferty 1931).
inline double chiSquaredTail(double x, double freedom) {
  const double spread = 2 / (9 * freedom);
  const double z = (std::cbrt(x / freedom) - (1 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

/// Directions of sample() against pdf() over cells of cosine and azimuth on the whole sphere, and the samples
/// that are dropped against what is missing from 1. Fails below 0.001 by chance over `cases` such tests
/// (Bonferroni). For lobes without deltas, smooth at a degree. `chance` is told -log10 of the probability.
inline void expectDensity(const Bsdf& bsdf, unsigned lobes, int cases, HardCase& chance) {
  constexpr int kRows = 30, kColumns = 16, kSamples = 60000, kSub = 16;
  std::vector<double> expected(kRows * kColumns + 1), seen(kRows * kColumns + 1);
  std::mt19937 engine(12);
  std::uniform_real_distribution<float> u(0, 1);
  const auto draw = [&] { return std::min(u(engine), 0.99999994f); };
  for (int i = 0; i < kSamples; ++i) {
    const float uLobe = draw(), x = draw(), y = draw();
    const auto s = bsdf.sample(uLobe, {x, y}, lobes);
    if (!s) {
      ++seen.back();
      continue;
    }
    ASSERT_FALSE(s->delta);
    ASSERT_NEAR(s->pdf, bsdf.pdf(s->direction, lobes), 2e-2f * s->pdf + 1e-4f);
    const float phi = std::atan2(s->direction.y, s->direction.x) + core::kPi;
    const int row = std::clamp(static_cast<int>((s->direction.z + 1) / 2 * kRows), 0, kRows - 1);
    const int column = std::clamp(static_cast<int>(phi / (2 * core::kPi) * kColumns), 0, kColumns - 1);
    ++seen[row * kColumns + column];
  }
  expected.back() = kSamples;
  for (int r = 0; r < kRows * kSub; ++r) {
    for (int c = 0; c < kColumns * kSub; ++c) {
      const float z = 2 * (static_cast<float>(r) + 0.5f) / (kRows * kSub) - 1;
      const float phi = 2 * core::kPi * (static_cast<float>(c) + 0.5f) / (kColumns * kSub) - core::kPi;
      const double p =
          bsdf.pdf(Patch::direction(z, phi), lobes) * 4 * M_PI / (kRows * kSub * kColumns * kSub) * kSamples;
      expected[(r / kSub) * kColumns + c / kSub] += p;
      expected.back() -= p;
    }
  }
  double chi = 0, pooledExpected = 0, pooledSeen = 0;
  int freedom = -1;
  const auto add = [&](double e, double o) {
    chi += (o - e) * (o - e) / e;
    ++freedom;
  };
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] >= 20) {
      add(expected[i], seen[i]);
    } else {
      pooledExpected += expected[i];
      pooledSeen += seen[i];
    }
  }
  if (pooledExpected >= 20) add(pooledExpected, pooledSeen);
  EXPECT_TRUE(chance.within(-std::log10(chiSquaredTail(chi, freedom)), -std::log10(0.001 / cases)))
      << chi << " with " << freedom << " degrees of freedom";
}

}  // namespace saccade::tests
