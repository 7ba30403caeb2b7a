// Flat light seen from a point: its irradiance in closed form, and directions towards it.
#pragma once

#include "raytrace/ray.h"

namespace saccade::raytrace {

/// What is left of a triangle above a point's horizons: a convex polygon, corners relative to the point.
struct SkyPolygon {
  static constexpr int kCorners = 6;  ///< a triangle that two planes cut, with one for rounding
  Vec3 corner[kCorners];
  int count = 0;  ///< 0: nothing, else >= 3
};

/// The part of the triangle whose directions d from `point` have dot(d, ng) > 0 and dot(d, normal) > 0.
SkyPolygon aboveHorizons(const Vec3 (&triangle)[3], const Vec3& point, const Vec3& ng, const Vec3& normal);

/// Integral of the cosine against `normal` over the polygon's directions, [0, pi]: the irradiance of a
/// uniform radiance of 1 (J. H. Lambert, Photometria, 1760). The polygon lies above the horizon of `normal`.
float projectedSolidAngle(const SkyPolygon& polygon, const Vec3& normal);

/// A direction towards the polygon.
struct SkyDirection {
  Vec3 direction{0};  ///< unit
  /// Cosine over density, as a multiple of its mean, which is projectedSolidAngle(polygon, normal): near 1.
  /// 0: there is none.
  float weight = 0;
};

/// Of one of the triangles of the polygon's fan, chosen by projected solid angle, spread evenly over its
/// solid angle (J. Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995). u in [0, 1)^2.
SkyDirection sampleSky(const SkyPolygon& polygon, const Vec3& normal, Vec2 u);

}  // namespace saccade::raytrace
