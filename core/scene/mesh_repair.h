// What a mesh needs before anything can rely on it.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace saccade::core {

struct RepairCounts {
  std::uint64_t triangles = 0;   ///< dropped: index out of range, vertex not finite, no area
  std::uint64_t attributes = 0;  ///< arrays of the wrong length, dropped
  std::uint64_t normals = 0;     ///< vertices whose normal was not usable
};

/// Drops what is unusable, fills normals (flat ones where there are none, which splits vertices) and, for a
/// material that needs them, tangents: the file's own or makeTangents'. Leaves the mesh within the contract
/// of core::Mesh.
void repairMesh(Mesh& mesh, const Material& material, RepairCounts& counts);

/// For every position the smallest index of a vertex with the same position (bit for bit, -0 = 0).
std::vector<std::uint32_t> weldedVertices(const std::vector<Vec3>& positions);

/// A mesh without triangles whose vertex i is the old vertex sources[i].
Mesh gatherVertices(const Mesh& mesh, const std::vector<std::uint32_t>& sources);

/// New mesh of the given triangles (indices into mesh.indices / 3); vertices in order of first use.
Mesh subMesh(const Mesh& mesh, const std::vector<std::uint32_t>& triangles);

}  // namespace saccade::core
