// Tangents of a mesh that brings none.
#pragma once

#include "core/scene/scene.h"

namespace saccade::core {

/// Fills mesh.tangents from the texture coordinates of the first of the material's normal map, clear coat's
/// normal map and anisotropy map, transformed as that texture is (else of the first UV set), by MikkTSpace's
/// rules (Mikkelsen 2008), which glTF asks for: unit tangents of the triangles in the plane of the vertex
/// normal, weighted by the corner's angle; a vertex between triangles whose picture is mirrored and others
/// becomes two. Departure: vertices that a file lists twice are not merged. Where there are no texture
/// coordinates: some direction in the surface. `mesh` has normals and sound triangles. Any thread.
void makeTangents(Mesh& mesh, const Material& material);

/// The texture whose coordinates makeTangents takes.
const TextureSlot& tangentSlot(const Material& material);

/// Some unit vector perpendicular to a unit vector.
Vec3 anyPerpendicular(const Vec3& n);

}  // namespace saccade::core
