#include "raytrace/microfacet.h"

#include <cmath>

namespace saccade::raytrace {

float Ggx::anisotropicD(const Vec3& h) const {
  const float a = h.x / x, b = h.y / y, d = a * a + b * b + h.z * h.z;
  return 1 / (core::kPi * x * y * d * d);
}

float Ggx::anisotropicLambda(const Vec3& v) const {
  const float c2 = std::max(v.z * v.z, 1e-12f), a = x * v.x, b = y * v.y;
  return 0.5f * (std::sqrt(1 + (a * a + b * b) / c2) - 1);
}

Frame::Frame(const Vec3& normal, const Vec3& tangent) : Frame(normal) {
  const Vec3 along = tangent - n * glm::dot(n, tangent);
  const float length = glm::length(along);
  if (!(length > 1e-4f)) return;
  t = along / length;
  b = glm::cross(n, t);
}

}  // namespace saccade::raytrace
