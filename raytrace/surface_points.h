// Points on the surfaces that show irradiance: where illumination maps are compared with their reference.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/world.h"

namespace saccade::raytrace {

/// A point of an object's surface, seen from one side.
struct SurfacePoint {
  std::uint32_t object = 0, triangle = 0;  ///< triangle of the object's mesh
  float b1 = 0, b2 = 0;                    ///< barycentric weights of corners 1 and 2
  bool front = true;
};

/// `count` points spread evenly over the area of all surfaces that show irradiance, both sides of
/// double-sided ones. A function of the scene's geometry and `seed`; charts change nothing. Empty where there
/// is no such surface. Any thread.
std::vector<SurfacePoint> surfacePoints(const World& world, std::size_t count, std::uint32_t seed);

/// What the maps hold there (World::setMaps), W/m^2.
Vec3 mapIrradiance(const World& world, const SurfacePoint& at);

}  // namespace saccade::raytrace
