#include "raytrace/bake/polygon_light.h"

#include <algorithm>
#include <cmath>

namespace saccade::raytrace {
namespace {

/// Normals that differ by less have one horizon.
constexpr float kSameNormal = 1 - 1e-6f;

/// Sutherland and Hodgman's step: what lies on the plane's positive side.
SkyPolygon cut(const SkyPolygon& in, const Vec3& plane) {
  SkyPolygon out;
  for (int i = 0; i < in.count; ++i) {
    const Vec3 &a = in.corner[i], &b = in.corner[(i + 1) % in.count];
    const float da = glm::dot(a, plane), db = glm::dot(b, plane);
    if (da > 0) out.corner[out.count++] = a;
    if ((da > 0) != (db > 0)) out.corner[out.count++] = a + (b - a) * (da / (da - db));
  }
  return out;
}

/// Twice the share of the edge from a to b in Lambert's sum: its angle times the cosine between its plane's
/// normal and `normal`. By way of b - a, which is exact where the edge is short.
float edgeTerm(const Vec3& a, const Vec3& b, const Vec3& normal) {
  const Vec3 cross = glm::cross(a, b - a);
  const float sine = glm::length(cross);
  if (!(sine > 0)) return 0;
  return std::atan2(sine, glm::dot(a, b)) * glm::dot(cross, normal) / sine;
}

float fanTriangle(const SkyPolygon& p, int k, const Vec3& normal) {
  return 0.5f * std::fabs(edgeTerm(p.corner[0], p.corner[k], normal) +
                          edgeTerm(p.corner[k], p.corner[k + 1], normal) +
                          edgeTerm(p.corner[k + 1], p.corner[0], normal));
}

/// The part of `v` at right angles to the unit vector `axis`, unit.
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis) {
  return glm::normalize(v - axis * glm::dot(v, axis));
}

/// Evenly over the spherical triangle a, b, c, whose solid angle is returned in `solidAngle`.
glm::dvec3 sphericalTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const Vec2& u,
                             double& solidAngle) {
  solidAngle = 2 * std::atan2(std::fabs(glm::dot(a, glm::cross(b, c))),
                              1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  const double cosAlpha = std::clamp(glm::dot(across(b, a), across(c, a)), -1.0, 1.0);
  const double sinAlpha = std::sqrt(1 - cosAlpha * cosAlpha);
  const double part = u.x * solidAngle, sinPart = std::sin(part), cosPart = std::cos(part);
  const double s = sinPart * cosAlpha - cosPart * sinAlpha, t = cosPart * cosAlpha + sinPart * sinAlpha;
  const double k = t - cosAlpha, l = s + sinAlpha * glm::dot(a, b);
  const double below = (l * s + k * t) * sinAlpha;
  const double q = below != 0 ? std::clamp(((l * t - k * s) * cosAlpha - l) / below, -1.0, 1.0) : 1.0;
  const glm::dvec3 cut = a * q + across(c, a) * std::sqrt(1 - q * q);
  const double z = 1 - u.y * (1 - glm::dot(cut, b));
  return b * z + across(cut, b) * std::sqrt(std::max(0.0, 1 - z * z));
}

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

SkyPolygon aboveHorizons(const Vec3 (&triangle)[3], const Vec3& point, const Vec3& ng, const Vec3& normal) {
  SkyPolygon p;
  for (const Vec3& corner : triangle) p.corner[p.count++] = corner - point;
  p = cut(p, normal);
  if (p.count > 0 && glm::dot(ng, normal) < kSameNormal) p = cut(p, ng);
  return p;
}

float projectedSolidAngle(const SkyPolygon& p, const Vec3& normal) {
  float sum = 0;
  for (int i = 0; i < p.count; ++i) sum += edgeTerm(p.corner[i], p.corner[(i + 1) % p.count], normal);
  return std::min(0.5f * std::fabs(sum), core::kPi);
}

SkyDirection sampleSky(const SkyPolygon& p, const Vec3& normal, Vec2 u) {
  float part[SkyPolygon::kCorners] = {}, total = 0;
  for (int k = 1; k + 1 < p.count; ++k) total += part[k] = fanTriangle(p, k, normal);
  if (!(total > 0)) return {};
  float rest = u.x * total;
  int k = 1;
  while (k + 2 < p.count && rest >= part[k]) rest -= part[k++];
  if (!(part[k] > 0)) return {};
  u.x = std::min(rest / part[k], 0x1.fffffep-1f);
  double solidAngle = 0;
  const glm::dvec3 direction =
      sphericalTriangle(glm::normalize(glm::dvec3(p.corner[0])), glm::normalize(glm::dvec3(p.corner[k])),
                        glm::normalize(glm::dvec3(p.corner[k + 1])), u, solidAngle);
  if (!finite(direction)) return {};
  SkyDirection out;
  out.direction = glm::normalize(Vec3(direction));
  out.weight = std::max(0.0f, glm::dot(out.direction, normal)) * static_cast<float>(solidAngle) / part[k];
  return out;
}

}  // namespace saccade::raytrace
