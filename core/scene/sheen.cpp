#include "core/scene/sheen.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/types.h"

namespace saccade::core {
namespace {

// Both tables run over t = sqrt(cosine), which puts rows where the lobe bends most (grazing), and over
// perceptual roughness.
constexpr int kCosines = 48, kRoughnesses = 33;
constexpr int kPolarSteps = 40, kAzimuthSteps = 24;  // half the circle: the lobe is symmetric
constexpr float kSmallestCosine = 1e-4f;

float roughnessOf(int row) {
  return kSmoothestSheen + (1 - kSmoothestSheen) * static_cast<float>(row) / (kRoughnesses - 1);
}

/// Estevez and Kulla's fit of ln Lambda, equation 4 and its table, mixed by (1 - alpha)^2.
struct Shadowing {
  float a, b, c, d, e;
  explicit Shadowing(float alpha) {
    const float t = (1 - alpha) * (1 - alpha);
    const auto mixed = [t](float smooth, float rough) { return t * smooth + (1 - t) * rough; };
    a = mixed(25.3245f, 21.5473f);
    b = mixed(3.32435f, 3.82987f);
    c = mixed(0.16801f, 0.19823f);
    d = mixed(-1.27393f, -1.97760f);
    e = mixed(-4.85967f, -4.32054f);
  }
  float fit(float x) const { return a / (1 + b * std::pow(x, c)) + d * x + e; }
  float lambda(float cosine) const {
    return cosine < 0.5f ? std::exp(fit(cosine)) : std::exp(2 * fit(0.5f) - fit(1 - cosine));
  }
};

/// Charlie's D.
float distribution(float cosHalf, float alpha) {
  const float sine2 = std::max(0.0f, 1 - cosHalf * cosHalf);
  return (2 + 1 / alpha) * std::pow(sine2, 0.5f / alpha) / (2 * kPi);
}

/// f cosLight as published.
float published(float cosView, float cosHalf, float alpha, float lambdas) {
  return distribution(cosHalf, alpha) / ((1 + lambdas) * 4 * cosView);
}

using Row = std::array<float, kCosines>;

float lookup(const Row& row, float cosine) {
  const float at = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * (kCosines - 1);
  const int i = std::min(static_cast<int>(at), kCosines - 2);
  return row[i] + (at - static_cast<float>(i)) * (row[i + 1] - row[i]);
}

/// The integral of lobe(cosLight, cosHalf) over the hemisphere for a view of that cosine; steps even in
/// sqrt(cosLight).
template <class Lobe>
float integrate(float cosView, Lobe&& lobe) {
  const float sinView = std::sqrt(1 - cosView * cosView);
  double sum = 0;
  for (int i = 0; i < kPolarSteps; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / kPolarSteps, cosLight = t * t;
    const float sinLight = std::sqrt(1 - cosLight * cosLight);
    const auto inner = lobe(cosLight);
    for (int j = 0; j < kAzimuthSteps; ++j) {
      const float phi = (static_cast<float>(j) + 0.5f) / kAzimuthSteps * kPi;
      const Vec3 h(sinView + sinLight * std::cos(phi), sinLight * std::sin(phi), cosView + cosLight);
      sum += static_cast<double>(2 * t * inner(h.z / glm::length(h)));
    }
  }
  return static_cast<float>(sum * 2 * M_PI / (kPolarSteps * kAzimuthSteps));
}

struct Table {
  std::array<Row, kRoughnesses> excess;  ///< albedo of the published lobe, at least 1
  std::array<Row, kRoughnesses> albedo;
  std::array<float, kRoughnesses> mean;

  Table() {
    for (int r = 0; r < kRoughnesses; ++r) {
      const float alpha = roughnessOf(r) * roughnessOf(r);
      const Shadowing shadowing(alpha);
      const auto fill = [&](Row& row, auto&& bound) {
        for (int c = 0; c < kCosines; ++c) {
          const float t = static_cast<float>(c) / (kCosines - 1);
          const float cosView = std::max(kSmallestCosine, t * t), lambdaView = shadowing.lambda(cosView);
          row[c] = integrate(cosView, [&](float cosLight) {
            const float lambdas = lambdaView + shadowing.lambda(cosLight), over = bound(cosView, cosLight);
            return [=](float cosHalf) { return published(cosView, cosHalf, alpha, lambdas) / over; };
          });
        }
      };
      fill(excess[r], [](float, float) { return 1.0f; });
      for (float& e : excess[r]) e = std::max(1.0f, e);
      fill(albedo[r], [&](float v, float l) { return std::max(lookup(excess[r], v), lookup(excess[r], l)); });
      mean[r] = meanOf(albedo[r]);
    }
  }

  /// 2 * integral of E(c) c dc.
  static float meanOf(const Row& row) {
    constexpr int kSteps = 512;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const float c = (static_cast<float>(i) + 0.5f) / kSteps;
      sum += 2.0 * static_cast<double>(lookup(row, c) * c) / kSteps;
    }
    return static_cast<float>(sum);
  }
};

const Table& table() {
  static const Table instance;
  return instance;
}

/// Two rows and the way between them.
struct Between {
  int row;
  float fraction;
  explicit Between(float roughness) {
    const float unit =
        (std::clamp(roughness, kSmoothestSheen, 1.0f) - kSmoothestSheen) / (1 - kSmoothestSheen);
    const float at = unit * (kRoughnesses - 1);
    row = std::min(static_cast<int>(at), kRoughnesses - 2);
    fraction = at - static_cast<float>(row);
  }
  float mix(float a, float b) const { return a + fraction * (b - a); }
  float of(const std::array<Row, kRoughnesses>& rows, float cosine) const {
    return mix(lookup(rows[row], cosine), lookup(rows[row + 1], cosine));
  }
};

}  // namespace

float sheenLobe(float cosView, float cosLight, float cosHalf, float roughness) {
  const float r = std::clamp(roughness, kSmoothestSheen, 1.0f), alpha = r * r;
  const Shadowing shadowing(alpha);
  const Between at(r);
  const float over = std::max(at.of(table().excess, cosView), at.of(table().excess, cosLight));
  return published(cosView, cosHalf, alpha, shadowing.lambda(cosView) + shadowing.lambda(cosLight)) / over;
}

float sheenAlbedo(float cosView, float roughness) { return Between(roughness).of(table().albedo, cosView); }

float sheenMeanAlbedo(float roughness) {
  const Between at(roughness);
  return at.mix(table().mean[at.row], table().mean[at.row + 1]);
}

}  // namespace saccade::core
