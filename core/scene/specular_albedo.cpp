#include "core/scene/specular_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/sheen.h"
#include "core/scene/texture_mean.h"

namespace saccade::core {
namespace {

// The table runs over t = sqrt(cosView), which puts rows where E bends most (grazing), and over perceptual
// roughness. Each entry is a midpoint rule over the distribution of visible normals.
constexpr int kCosines = 64;
constexpr int kRoughnesses = 33;
constexpr int kPolarSteps = 32;
constexpr int kAzimuthSteps = 24;  // half the circle: the integrand is symmetric
constexpr float kSmallestCosine = 1e-4f;
/// See dielectricF90.
constexpr float kF90OverF0 = 50;

/// Smith's Lambda times two, plus one, times cosine: cos + sqrt(alpha^2 + (1 - alpha^2) cos^2) = cos * (2 + 2
/// L).
float smithTerm(float cosine, float alpha2) {
  return cosine + std::sqrt(alpha2 + (1 - alpha2) * cosine * cosine);
}

/// Height-correlated G2 over G1(view): the weight of a sample of the visible normals (Heitz 2014, 2018).
float weight(float cosView, float cosLight, float alpha2) {
  const float view = std::sqrt(alpha2 + (1 - alpha2) * cosView * cosView);
  const float light = std::sqrt(alpha2 + (1 - alpha2) * cosLight * cosLight);
  return cosLight * smithTerm(cosView, alpha2) / (cosLight * view + cosView * light);
}

/// The midpoint rule's points on the half disc, the same for every entry: r and (cos, sin) of the angle
/// around the plane of incidence. a = r cos is symmetric, b = r sin is not.
struct DiscPoints {
  std::array<float, kPolarSteps> r;
  std::array<float, kAzimuthSteps> cosine, sine;

  DiscPoints() {
    for (int i = 0; i < kPolarSteps; ++i) r[i] = std::sqrt((static_cast<float>(i) + 0.5f) / kPolarSteps);
    for (int j = 0; j < kAzimuthSteps; ++j) {
      const float phi = (static_cast<float>(j) + 0.5f) / kAzimuthSteps * kPi - 0.5f * kPi;
      cosine[j] = std::cos(phi);
      sine[j] = std::sin(phi);
    }
  }
};

/// Visible normals for view (sin, 0, cos) by Heitz 2018.
class VisibleNormals {
 public:
  VisibleNormals(const Vec3& view, float alpha)
      : alpha_(alpha),
        stretched_(glm::normalize(Vec3(alpha * view.x, 0, view.z))),
        t2_(glm::cross(stretched_, t1_)),
        s_(0.5f * (1 + stretched_.z)) {}

  /// For the point of the disc at r in (0, 1) and an angle.
  Vec3 at(float r, float cosine, float sine) const {
    const float a = r * cosine;
    const float b = (1 - s_) * std::sqrt(std::max(0.0f, 1 - a * a)) + s_ * r * sine;
    const Vec3 n = a * t1_ + b * t2_ + std::sqrt(std::max(0.0f, 1 - a * a - b * b)) * stretched_;
    return glm::normalize(Vec3(alpha_ * n.x, alpha_ * n.y, std::max(1e-7f, n.z)));
  }

 private:
  float alpha_;
  Vec3 stretched_, t1_{0, 1, 0}, t2_;
  float s_;
};

AlbedoPair integrate(const DiscPoints& disc, float cosView, float roughness) {
  const float alpha = roughness * roughness;
  const Vec3 view(std::sqrt(std::max(0.0f, 1 - cosView * cosView)), 0, cosView);
  const VisibleNormals normals(view, alpha);
  double scale = 0, bias = 0;
  for (int i = 0; i < kPolarSteps; ++i) {
    for (int j = 0; j < kAzimuthSteps; ++j) {
      const Vec3 normal = normals.at(disc.r[i], disc.cosine[j], disc.sine[j]);
      const float cosHalf = std::min(1.0f, glm::dot(view, normal));
      const float cosLight = 2 * cosHalf * normal.z - view.z;
      if (cosHalf <= 0 || cosLight <= 0) continue;
      const float w = weight(cosView, cosLight, alpha * alpha);
      const float away = 1 - cosHalf, fresnel = away * away * (away * away) * away;
      scale += static_cast<double>(w * (1 - fresnel));
      bias += static_cast<double>(w * fresnel);
    }
  }
  constexpr double kCount = kPolarSteps * kAzimuthSteps;
  return {static_cast<float>(scale / kCount), static_cast<float>(bias / kCount)};
}

AlbedoPair mix(const AlbedoPair& a, const AlbedoPair& b, float t) {
  return {a.scale + t * (b.scale - a.scale), a.bias + t * (b.bias - a.bias)};
}

float unit(float x) { return x >= 0 ? std::min(x, 1.0f) : 0.0f; }  // NaN gives 0

struct Table {
  std::array<std::array<AlbedoPair, kCosines>, kRoughnesses> directional;
  std::array<AlbedoPair, kRoughnesses> mean;

  Table() {
    const DiscPoints disc;
    for (int r = 0; r < kRoughnesses; ++r) {
      for (int c = 0; c < kCosines; ++c) {
        const float t = static_cast<float>(c) / (kCosines - 1);
        directional[r][c] =
            integrate(disc, std::max(kSmallestCosine, t * t), static_cast<float>(r) / (kRoughnesses - 1));
      }
      mean[r] = meanOf(directional[r]);
    }
  }

  static AlbedoPair lookup(const std::array<AlbedoPair, kCosines>& row, float cosView) {
    const float at = std::sqrt(cosView) * (kCosines - 1);
    const int i = std::min(static_cast<int>(at), kCosines - 2);
    return mix(row[i], row[i + 1], at - static_cast<float>(i));
  }

  /// 2 * integral of E(c) c dc, midpoint rule on the interpolated row.
  static AlbedoPair meanOf(const std::array<AlbedoPair, kCosines>& row) {
    constexpr int kSteps = 1024;
    double scale = 0, bias = 0;
    for (int i = 0; i < kSteps; ++i) {
      const float c = (static_cast<float>(i) + 0.5f) / kSteps;
      const AlbedoPair e = lookup(row, c);
      scale += 2.0 * static_cast<double>(e.scale * c) / kSteps;
      bias += 2.0 * static_cast<double>(e.bias * c) / kSteps;
    }
    return {static_cast<float>(scale), static_cast<float>(bias)};
  }
};

const Table& table() {
  static const Table instance;
  return instance;
}

struct RoughnessRow {
  int index;
  float fraction;
};
RoughnessRow rowOf(float roughness) {
  const float at = unit(roughness) * (kRoughnesses - 1);
  const int i = std::min(static_cast<int>(at), kRoughnesses - 2);
  return {i, at - static_cast<float>(i)};
}

}  // namespace

AlbedoPair directionalAlbedo(float cosView, float roughness) {
  const Table& t = table();
  const RoughnessRow row = rowOf(roughness);
  const float c = unit(cosView);
  return mix(Table::lookup(t.directional[row.index], c), Table::lookup(t.directional[row.index + 1], c),
             row.fraction);
}

AlbedoPair meanAlbedo(float roughness) {
  const Table& t = table();
  const RoughnessRow row = rowOf(roughness);
  return mix(t.mean[row.index], t.mean[row.index + 1], row.fraction);
}

Vec3 dielectricF0(const Material& material) {
  const float r = (material.ior - 1) / (material.ior + 1);
  return glm::min(r * r * material.specularColor * material.specular, Vec3(1));
}

float dielectricF90(const Vec3& f0, float specular) {
  return std::min(unit(specular), kF90OverF0 * std::max({f0.x, f0.y, f0.z, 0.0f}));
}

float coatTransmission(float coat, float coatRoughness, float cosine) {
  const AlbedoPair pair = directionalAlbedo(cosine, coatRoughness);
  return 1 - coat * (kCoatF0 * pair.scale + pair.bias);
}

float sheenTransmission(float sheen, float sheenRoughness, float cosine) {
  return 1 - sheen * sheenAlbedo(cosine, sheenRoughness);
}

Vec3 transmission(const OverLambert& over, float cosine, float coatCosine) {
  Vec3 t = Vec3(1) - lobeAlbedo(directionalAlbedo(cosine, over.roughness), over.f0, over.f90);
  if (over.sheen > 0) t *= sheenTransmission(over.sheen, over.sheenRoughness, cosine);
  if (over.coat > 0) t *= coatTransmission(over.coat, over.coatRoughness, coatCosine);
  return t;
}

Vec3 meanTransmission(const OverLambert& over) {
  // Gauss-Legendre over t in [0, 1] with cosine = t^2: 2 c dc = 4 t^3 dt.
  constexpr float kNode[] = {0.0198550718f, 0.1016667613f, 0.2372337950f, 0.4082826788f,
                             0.5917173212f, 0.7627662050f, 0.8983332387f, 0.9801449282f};
  constexpr float kWeight[] = {0.0506142681f, 0.1111905172f, 0.1568533229f, 0.1813418917f,
                               0.1813418917f, 0.1568533229f, 0.1111905172f, 0.0506142681f};
  Vec3 sum(0);
  for (int i = 0; i < 8; ++i) {
    const float t = kNode[i], cosine = t * t;
    sum += transmission(over, cosine, cosine) * (4 * t * cosine * kWeight[i]);
  }
  return sum;
}

float baseDiffuseFactor(const Scene& scene, const Material& material) {
  if (material.unlit || material.ward) return 1;
  const MaterialMeans means = materialMeans(scene, material);
  if (means.over.sheen > 0 || means.over.coat > 0 || material.anisotropy > 0)
    return luminance(meanTransmission(means.over));
  return 1 - luminance(means.dielectricAlbedo);
}

}  // namespace saccade::core
