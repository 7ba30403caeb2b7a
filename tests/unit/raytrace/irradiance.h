// Irradiance by light sampling, and its truth for polygons.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "raytrace/lights.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct Estimate {
  double mean, sigma;
};

/// Irradiance at a point with a normal, by light sampling; blockers count.
inline Estimate irradianceBySampling(const World& world, const Vec3& point, const Vec3& normal, int n) {
  std::mt19937 engine(21);
  std::uniform_real_distribution<float> u(0, 1);
  RayCounters counters;
  Surface from;
  from.position = point;
  from.ng = from.ns = normal;
  const LightChoice choice = world.lights().choose(point);
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    LightSample s;
    double e = 0;
    if (world.lights().sample(choice, u(engine), {u(engine), u(engine)}, s)) {
      const float cosine = std::max(0.0f, glm::dot(s.direction, normal));
      if (cosine > 0) e = s.radiance.x * cosine / s.pdf * world.transmittance(shadowRay(from, s), counters);
    }
    sum += e;
    squares += e * e;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

/// Irradiance from a polygon of radiance 1 above the horizon of `normal` (Lambert's formula), after clipping.
inline double polygonIrradiance(const Vec3& point, const Vec3& normal, const std::vector<Vec3>& corners) {
  std::vector<glm::dvec3> clipped;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a(corners[i] - point), b(corners[(i + 1) % corners.size()] - point), n(normal);
    const double da = glm::dot(a, n), db = glm::dot(b, n);
    if (da >= 0) clipped.push_back(a);
    if ((da > 0) != (db > 0) && da != db) clipped.push_back(a + (b - a) * (da / (da - db)));
  }
  double sum = 0;
  for (std::size_t i = 0; i < clipped.size(); ++i) {
    const glm::dvec3 a = glm::normalize(clipped[i]), b = glm::normalize(clipped[(i + 1) % clipped.size()]);
    const glm::dvec3 cross = glm::cross(a, b);
    if (glm::length(cross) < 1e-12) continue;
    sum += std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) *
           glm::dot(glm::normalize(cross), glm::dvec3(normal));
  }
  return std::fabs(sum) / 2;
}

}  // namespace saccade::raytrace
