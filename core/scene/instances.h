// Which meshes are shared between objects, and which are copied into the world for each.
#pragma once

#include <cstddef>

#include "core/load_budget.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// Triangles that a scene may hold in memory, and that it may show, instances counted one by one.
inline constexpr std::size_t kMaxStoredTriangles = 64u << 20;
inline constexpr std::size_t kMaxShownTriangles = std::size_t{1} << 30;

/// A mesh pays as an instanced one from this many triangles on: placing it costs about as many bytes, and
/// rays pay for the way to it.
inline constexpr std::size_t kFewestInstancedTriangles = 64;
/// Sharing pays for a scene when it saves this many triangles; below, rays are faster than memory is dear.
inline constexpr std::size_t kSharingPays = 1u << 16;

/// In place, as Placement says. The mesh is no longer instanced.
void bakeIntoWorld(Mesh& mesh, const Mat4& meshToWorld);

/// Of an object in the world, m^2.
double surfaceArea(const Scene& scene, const Object& object);

/// Leaves instanced only what pays; gives every other object a mesh of its own in world space. A mesh stays
/// instanced when it has at least kFewestInstancedTriangles and at least two objects place it, not counting
/// objects that emit (every emitting triangle has its own place in the light tables) and those whose
/// transform is not instanceable, and when all such meshes together save at least `pays` triangles. Meshes
/// that nobody uses are emptied. Throws core::Error when the result has too many triangles, and what
/// `budget`, charged for every copy, throws.
void chooseInstances(Scene& scene, std::size_t pays, LoadBudget* budget = nullptr);

}  // namespace saccade::core
