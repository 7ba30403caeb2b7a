// An instanced mesh in its place: what rays and hits need to go from the world to the mesh and back.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/scene/placement.h"
#include "core/scene/scene.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

using core::Vec4;

/// Half a unit in the last place of 1, times the number of roundings between vertices, hit point, shifted
/// origin and Embree's own differences: a surface's offset per metre of coordinate. Measured in
/// tests/unit/raytrace/rays_test.cpp, 20,000 rays at 10 km: 4,100 meet their own surface with 1 rounding, 114
/// with 2, none with 4; four times that for safety.
inline constexpr float kOffsetPerCoordinate = 16 * 0x1p-24f;

/// `meshToWorld` must be instanceable (core::isInstanceable).
struct Instance : core::Placement {
  core::Mat3 inverse{1};  ///< of `linear`
  float offsetScale = 1;  ///< world offset = offsetScale * TriangleRecord::offset + offsetBase
  float offsetBase = 0;
  float stretch = 1;  ///< |inverse v| <= stretch |v|
  Vec4 lightmapScaleOffset{1, 1, 0, 0};

  Instance(const core::Mat4& meshToWorld, const Vec4& lightmap)
      : Placement(meshToWorld), lightmapScaleOffset(lightmap) {
    const glm::dmat3 precise = glm::inverse(glm::dmat3(linear));
    inverse = core::Mat3(precise);
    stretch = frobenius(inverse);
    // A ray goes to the mesh and its hit comes back: the roundings on the mesh's side count `condition`
    // times.
    const float condition = frobenius(linear) * stretch;
    const Vec3 t = glm::abs(translation);
    offsetScale = condition * frobenius(linear);
    offsetBase = condition * std::max({t.x, t.y, t.z}) * kOffsetPerCoordinate;
  }

  /// The same ray parameters as in the world.
  Ray toMesh(const Ray& r) const {
    return {inverse * (r.origin - translation), inverse * r.direction, r.tNear, r.tFar};
  }
  float offset(float meshOffset) const { return offsetScale * meshOffset + offsetBase; }
  Vec2 lightmapUv(const Vec2& uv) const { return core::placeInAtlas(lightmapScaleOffset, uv); }
  /// No component of a ray may be larger for all of it to stay within kLargestRay in the mesh's space.
  float largestRay() const {
    const Vec3 t = glm::abs(translation);
    return kLargestRay / std::max(1.0f, 2 * stretch) - std::max({t.x, t.y, t.z});
  }

 private:
  static float frobenius(const core::Mat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  }
};

}  // namespace saccade::raytrace
