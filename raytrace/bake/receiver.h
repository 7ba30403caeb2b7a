// A point of a texel as lights see it.
#pragma once

#include <algorithm>

#include "raytrace/bake/texel_map.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {

struct Receiver {
  Surface surface;
  Vec3 normal;  ///< interpolated: what irradiance is measured against

  Receiver(const World& world, const MeshPoint& at, bool front)
      : surface(
            surfaceOn(world, at.object, world.firstTriangle(at.object) + at.triangle, at.b1, at.b2, front)),
        normal(smoothNormal(world, at.object, surface.triangle, at.b1, at.b2, surface.ng)) {}

  /// Cosine against the interpolated normal; 0 below either horizon.
  float cosine(const Vec3& direction) const {
    return glm::dot(direction, surface.ng) > 0 ? std::max(0.0f, glm::dot(direction, normal)) : 0.0f;
  }
};

}  // namespace saccade::raytrace
