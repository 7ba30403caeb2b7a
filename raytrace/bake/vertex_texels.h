// Light kept by vertex: which vertices of a mesh share a texel, and where the texels lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::raytrace {

/// Vertices with the same position and normal (files double them where texture coordinates break) share one
/// texel, so that light has no seam there; where normals break they do not, for light breaks there too.
struct VertexTexels {
  std::vector<std::uint32_t> numberOf;  ///< texel of each vertex, from 0 in the order of the vertices
  std::size_t count = 0;                ///< of texels

  /// Side and height of the block that they fill row by row.
  int width() const;
  int height() const;
};

VertexTexels vertexTexels(const core::Mesh& mesh);

}  // namespace saccade::raytrace
