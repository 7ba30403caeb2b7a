// Fresnel's reflectance and the GGX distribution of facets, isotropic and anisotropic. Directions are local:
// z is the normal.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/types.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

/// Perceptual roughness squared; below this a lobe is a delta.
inline constexpr float kDeltaAlpha = 1e-3f;
/// Directions below the horizon are lifted to this cosine.
inline constexpr float kLowestCosine = 1e-6f;

/// Unpolarised Fresnel reflectance of a dielectric. cosI in [0, 1], eta = n_t / n_i > 0; 1 beyond the
/// critical angle.
inline float fresnelDielectric(float cosI, float eta) {
  const float c = std::clamp(cosI, 0.0f, 1.0f);
  const float g2 = eta * eta - 1 + c * c;
  if (!(g2 > 0)) return 1;
  const float g = std::sqrt(g2);
  // Rs and Rp with g = eta cos_t: no division by a vanishing sine.
  const float s = (c - g) / (c + g);
  const float p = (eta * eta * c - g) / (eta * eta * c + g);
  return std::min(0.5f * (s * s + p * p), 1.0f);
}

inline Vec3 schlick(const Vec3& f0, float f90, float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
  const float m2 = m * m;
  return f0 + (Vec3(f90) - f0) * (m2 * m2 * m);
}

inline float largest(const Vec3& c) { return std::max({c.x, c.y, c.z}); }

/// GGX density of facet normals, alpha > 0, h unit in the local frame (x and y carry the precision near the
/// pole).
inline float ggxD(const Vec3& h, float alpha) {
  const float a2 = alpha * alpha;
  const float d = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
  return a2 / (core::kPi * d * d);
}
inline constexpr float kLeastCosine2 = 1e-12f;  ///< squared
/// Smith's Lambda.
inline float ggxLambda(float cosV, float alpha) {
  const float c2 = std::max(cosV * cosV, kLeastCosine2);
  return 0.5f * (std::sqrt(1 + alpha * alpha * std::max(0.0f, 1 - c2) / c2) - 1);
}
/// Visible normal for a view direction in the local frame, v.z > 0, by the spherical caps of Dupuy and
/// Benyoub 2023.
inline Vec3 sampleVisibleNormal(const Vec3& v, float alphaX, float alphaY, const Vec2& u) {
  const Vec3 stretched = glm::normalize(Vec3(alphaX * v.x, alphaY * v.y, v.z));
  // A direction in the cap of mirror directions that the hemisphere allows; its half vector is the normal.
  const float phi = 2 * core::kPi * u.y;
  const float z = (1 - u.x) * (1 + stretched.z) - stretched.z;
  const float s = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
  const Vec3 h(s * std::cos(phi) + stretched.x, s * std::sin(phi) + stretched.y, z + stretched.z);
  return glm::normalize(Vec3(alphaX * h.x, alphaY * h.y, std::max(h.z, kLowestCosine)));
}
inline Vec3 sampleVisibleNormal(const Vec3& v, float alpha, const Vec2& u) {
  return sampleVisibleNormal(v, alpha, alpha, u);
}

/// GGX with an alpha > 0 along x and one along y (Heitz 2014, equations 85 and 86; 2018). Equal alphas take
/// the isotropic functions, bit for bit.
struct Ggx {
  float x = 1, y = 1;

  bool isotropic() const { return x == y; }
  float widest() const { return std::max(x, y); }
  float d(const Vec3& h) const { return isotropic() ? ggxD(h, x) : anisotropicD(h); }
  float lambda(const Vec3& v) const { return isotropic() ? ggxLambda(v.z, x) : anisotropicLambda(v); }
  Vec3 sampleVisible(const Vec3& v, const Vec2& u) const { return sampleVisibleNormal(v, x, y, u); }

 private:
  float anisotropicD(const Vec3& h) const;
  float anisotropicLambda(const Vec3& v) const;
};

/// An orthonormal basis around a unit normal.
struct Frame {
  Vec3 t, b, n;
  /// Duff et al. 2017; sound at n = (0, 0, -1).
  explicit Frame(const Vec3& normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z);
    const float c = n.x * n.y * a;
    t = {1 + sign * n.x * n.x * a, sign * c, -sign * n.x};
    b = {c, sign + n.y * n.y * a, -n.y};
  }
  /// t along `tangent` as far as the normal allows; the basis above when they are parallel or it is 0.
  Frame(const Vec3& normal, const Vec3& tangent);
  Vec3 toLocal(const Vec3& w) const { return {glm::dot(w, t), glm::dot(w, b), glm::dot(w, n)}; }
  Vec3 toWorld(const Vec3& w) const { return w.x * t + w.y * b + w.z * n; }
};

}  // namespace saccade::raytrace
