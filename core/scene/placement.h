// How an object's transform moves what belongs to a mesh.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/types.h"

namespace saccade::core {

/// Object::meshToWorld, taken apart. Fronts stay outside under mirroring transforms: normals follow the
/// cofactors (the inverse transpose times the determinant, which also stands for singular matrices) times the
/// sign of the determinant, and corners 1 and 2 of a mirrored triangle change places.
struct Placement {
  Mat3 linear{1};
  Vec3 translation{0};
  Mat3 normalToWorld{1};  ///< its results are not unit
  bool mirrored = false;

  Placement() = default;
  explicit Placement(const Mat4& meshToWorld) : linear(meshToWorld), translation(meshToWorld[3]) {
    mirrored = glm::determinant(glm::dmat3(linear)) < 0;
    normalToWorld = Mat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                         glm::cross(linear[0], linear[1]));
    if (mirrored) normalToWorld = -normalToWorld;
  }
  Vec3 point(const Vec3& p) const { return linear * p + translation; }
  /// A tangent with its handedness, unit again.
  Vec4 tangent(const Vec4& t) const { return Vec4(glm::normalize(linear * Vec3(t)), mirrored ? -t.w : t.w); }
};

/// Whether rays can be taken into the mesh's space and hits out of it with the precision of floats: the
/// transform is finite, neither singular nor far from it, and of a size that products of three stay in range.
/// Else the mesh has to be baked into world space.
inline bool isInstanceable(const Mat4& meshToWorld) {
  constexpr double kLargestScale = 0x1p32, kLargestCondition = 0x1p12, kLargestDistance = 0x1p26;
  const glm::dmat3 linear(meshToWorld);
  const auto size = [](const glm::dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  };
  const double scale = size(linear), inverse = size(glm::inverse(linear));
  const glm::dvec3 t = glm::abs(glm::dvec3(meshToWorld[3]));
  // Written so that NaN fails.
  return scale <= kLargestScale && inverse <= kLargestScale && scale * inverse <= kLargestCondition &&
         std::max({t.x, t.y, t.z}) <= kLargestDistance;
}

}  // namespace saccade::core
