#include "raytrace/microfacet.h"

#include <cmath>

namespace saccade::raytrace {
namespace {

/// Visible normal by the spherical caps of Dupuy and Benyoub 2023.
Vec3 sampleCap(const Vec3& v, float alphaX, float alphaY, const Vec2& u) {
  const Vec3 stretched = glm::normalize(Vec3(alphaX * v.x, alphaY * v.y, v.z));
  // A direction in the cap of mirror directions that the hemisphere allows; its half vector is the normal.
  const float phi = 2 * core::kPi * u.y;
  const float z = (1 - u.x) * (1 + stretched.z) - stretched.z;
  const float s = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
  const Vec3 h(s * std::cos(phi) + stretched.x, s * std::sin(phi) + stretched.y, z + stretched.z);
  return glm::normalize(Vec3(alphaX * h.x, alphaY * h.y, std::max(h.z, kLowestCosine)));
}

}  // namespace

float fresnelDielectric(float cosI, float eta) {
  const float c = std::clamp(cosI, 0.0f, 1.0f);
  const float g2 = eta * eta - 1 + c * c;
  if (!(g2 > 0)) return 1;
  const float g = std::sqrt(g2);
  // Rs and Rp with g = eta cos_t: no division by a vanishing sine.
  const float s = (c - g) / (c + g);
  const float p = (eta * eta * c - g) / (eta * eta * c + g);
  return std::min(0.5f * (s * s + p * p), 1.0f);
}

float ggxD(const Vec3& h, float alpha) {
  const float a2 = alpha * alpha;
  const float d = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
  return a2 / (core::kPi * d * d);
}

float ggxLambda(float cosV, float alpha) {
  const float c2 = std::max(cosV * cosV, 1e-12f);
  return 0.5f * (std::sqrt(1 + alpha * alpha * std::max(0.0f, 1 - c2) / c2) - 1);
}

Vec3 sampleVisibleNormal(const Vec3& v, float alpha, const Vec2& u) { return sampleCap(v, alpha, alpha, u); }

float Ggx::anisotropicD(const Vec3& h) const {
  const float a = h.x / x, b = h.y / y, d = a * a + b * b + h.z * h.z;
  return 1 / (core::kPi * x * y * d * d);
}

float Ggx::anisotropicLambda(const Vec3& v) const {
  const float c2 = std::max(v.z * v.z, 1e-12f), a = x * v.x, b = y * v.y;
  return 0.5f * (std::sqrt(1 + (a * a + b * b) / c2) - 1);
}

Vec3 Ggx::sampleVisible(const Vec3& v, const Vec2& u) const { return sampleCap(v, x, y, u); }

Frame::Frame(const Vec3& normal) : n(normal) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1 / (sign + n.z);
  const float c = n.x * n.y * a;
  t = {1 + sign * n.x * n.x * a, sign * c, -sign * n.x};
  b = {c, sign + n.y * n.y * a, -n.y};
}

Frame::Frame(const Vec3& normal, const Vec3& tangent) : Frame(normal) {
  const Vec3 along = tangent - n * glm::dot(n, tangent);
  const float length = glm::length(along);
  if (!(length > 1e-4f)) return;
  t = along / length;
  b = glm::cross(n, t);
}

}  // namespace saccade::raytrace
