// Triangle meshes on their way into a GLB file: metres, Y up, counter-clockwise seen from outside.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace saccade::data {

using core::Mat4;
using core::Vec2;
using core::Vec3;
using core::Vec4;

/// positions, normals (unit) and uvs (v downwards) are equally long; 3 indices a triangle.
struct MeshData {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<std::uint32_t> indices;

  std::uint32_t addVertex(const Vec3& position, const Vec3& normal, const Vec2& uv);
  /// Two triangles a b c, a c d; a triangle with two equal positions is left out (poles of spheres).
  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Appends `other`, moved by `transform` (a similarity: rotation, translation, uniform scale).
  void append(const MeshData& other, const Mat4& transform = Mat4(1));
  std::size_t triangleCount() const { return indices.size() / 3; }
};

/// Tangents along +u with w such that cross(normal, tangent) * w points to -v (up in the image).
std::vector<Vec4> tangentsOf(const MeshData& mesh);

}  // namespace saccade::data
