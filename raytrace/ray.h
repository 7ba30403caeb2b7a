// Rays, hits, counters, and the one guard that every ray passes.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/math/types.h"

namespace saccade::raytrace {

using core::Vec2;
using core::Vec3;

/// direction need not be unit; t counts in its length. 0 <= tNear <= tFar.
struct Ray {
  Vec3 origin{0};
  Vec3 direction{0, 0, -1};
  float tNear = 0;
  float tFar = core::kInfinity;
};

/// Nearest hit. Position = (1 - u - v) p0 + u p1 + v p2.
struct Hit {
  std::uint32_t triangle = 0;  ///< index over all stored triangles (World::record)
  std::uint32_t object = 0;    ///< index into the scene's objects
  float t = 0, u = 0, v = 0;
  Vec3 ng{0};  ///< geometric normal in the world, not unit; its front is the triangle's front
};

class RayLog;

/// One per thread. `log`, when set, receives every ray in order (benchmark only).
struct RayCounters {
  std::uint64_t rays = 0;       ///< traced, shadow rays included
  std::uint64_t refused = 0;    ///< stopped by the guard: a miss
  std::uint64_t nonFinite = 0;  ///< corrections that were not finite and became 0
  RayLog* log = nullptr;

  void add(const RayCounters& o) {
    rays += o.rays;
    refused += o.refused;
    nonFinite += o.nonFinite;
  }
};

inline constexpr float kLargestRay = 1.8e18f;  ///< component of a ray that Embree takes

/// The guard. Embree 3.13.5 as Debian builds it aborts on NaN, Inf, components above kLargestRay and negative
/// tNear; a zero or subnormal direction has no meaning. False = the ray is a miss. `largest`: less than
/// kLargestRay where instances scale rays up.
inline bool traceable(const Ray& r, float largest = kLargestRay) {
  const bool forward = (r.tNear >= 0) & (r.tNear <= r.tFar) & (r.tNear <= kLargestRay);
  // Nearly all rays pass by two sums: no addend is larger, and of three that make one half one is no
  // subnormal.
  const float way = std::fabs(r.direction.x) + std::fabs(r.direction.y) + std::fabs(r.direction.z);
  const float all = std::fabs(r.origin.x) + std::fabs(r.origin.y) + std::fabs(r.origin.z) + way;
  if (forward & (way >= 0.5f) & (all <= largest)) return true;
  const auto in = [largest](float x) { return std::fabs(x) <= largest; };  // false for NaN
  const bool bounded = in(r.origin.x) & in(r.origin.y) & in(r.origin.z) & in(r.direction.x) &
                       in(r.direction.y) & in(r.direction.z);
  const auto counts = [](float x) { return std::fabs(x) >= std::numeric_limits<float>::min(); };
  const bool directed = counts(r.direction.x) | counts(r.direction.y) | counts(r.direction.z);
  return bounded & directed & forward;
}

}  // namespace saccade::raytrace
