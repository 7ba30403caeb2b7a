// Splitting a primitive into clusters of near parts, and telling whether a cluster is watertight (Haber 2001,
// section 4.1: objects are groups of near primitives of one material).
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::core {

struct Cluster {
  std::vector<std::uint32_t> triangles;  ///< ascending
  bool closed = false;                   ///< every edge of the welded mesh is used once in either direction
};

/// Connected parts (by position) of the mesh, put together where no gap wider than a tenth of their common
/// box separates them along an axis. With `separateClosed`, watertight and open parts never share a cluster.
/// A mesh that is connected is one cluster. Ordered by smallest triangle. Deterministic.
std::vector<Cluster> clusterMesh(const Mesh& mesh, bool separateClosed);

}  // namespace saccade::core
