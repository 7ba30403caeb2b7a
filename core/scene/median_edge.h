// How finely a mesh is cut.
#pragma once

#include <cstddef>

#include "core/scene/scene.h"

namespace saccade::core {

/// Meshes of fewer vertices do not keep their light by vertex: nothing to gain.
inline constexpr std::size_t kDenseVertices = 1024;

/// Of the edges of all triangles, in the mesh's space; 0 without triangles. Some ten nanoseconds an edge.
double medianEdge(const Mesh& mesh);

}  // namespace saccade::core
