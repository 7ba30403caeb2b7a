// Fresnel's reflectance and the GGX distribution of facets, isotropic and anisotropic. Directions are local:
// z is the normal.
#pragma once

#include <algorithm>

#include "core/math/types.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

/// Perceptual roughness squared; below this a lobe is a delta.
inline constexpr float kDeltaAlpha = 1e-3f;
/// Directions below the horizon are lifted to this cosine.
inline constexpr float kLowestCosine = 1e-6f;

/// Unpolarised Fresnel reflectance of a dielectric. cosI in [0, 1], eta = n_t / n_i > 0; 1 beyond the
/// critical angle.
float fresnelDielectric(float cosI, float eta);

inline Vec3 schlick(const Vec3& f0, float f90, float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
  const float m2 = m * m;
  return f0 + (Vec3(f90) - f0) * (m2 * m2 * m);
}

inline float largest(const Vec3& c) { return std::max({c.x, c.y, c.z}); }

/// GGX density of facet normals, alpha > 0, h unit in the local frame (x and y carry the precision near the
/// pole).
float ggxD(const Vec3& h, float alpha);
/// Smith's Lambda.
float ggxLambda(float cosV, float alpha);
/// Visible normal for a view direction in the local frame, v.z > 0.
Vec3 sampleVisibleNormal(const Vec3& v, float alpha, const Vec2& u);

/// GGX with an alpha > 0 along x and one along y (Heitz 2014, equations 85 and 86; 2018). Equal alphas take
/// the isotropic functions, bit for bit.
struct Ggx {
  float x = 1, y = 1;

  bool isotropic() const { return x == y; }
  float widest() const { return std::max(x, y); }
  float d(const Vec3& h) const { return isotropic() ? ggxD(h, x) : anisotropicD(h); }
  float lambda(const Vec3& v) const { return isotropic() ? ggxLambda(v.z, x) : anisotropicLambda(v); }
  Vec3 sampleVisible(const Vec3& v, const Vec2& u) const;

 private:
  float anisotropicD(const Vec3& h) const;
  float anisotropicLambda(const Vec3& v) const;
};

/// An orthonormal basis around a unit normal.
struct Frame {
  Vec3 t, b, n;
  /// Duff et al. 2017; sound at n = (0, 0, -1).
  explicit Frame(const Vec3& normal);
  /// t along `tangent` as far as the normal allows; the basis above when they are parallel or it is 0.
  Frame(const Vec3& normal, const Vec3& tangent);
  Vec3 toLocal(const Vec3& w) const { return {glm::dot(w, t), glm::dot(w, b), glm::dot(w, n)}; }
  Vec3 toWorld(const Vec3& w) const { return w.x * t + w.y * b + w.z * n; }
};

}  // namespace saccade::raytrace
