// One state of a scene, as far as illumination maps depend on it: enough to find, later, what has changed,
// and to bound what that does to the light.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::core {

/// Hashes of what makes up an object. Names and places in lists do not count.
struct ObjectState {
  std::uint64_t shape = 0;  ///< its triangles and where they stand
  std::uint64_t look = 0;   ///< its material and the textures of that, the emission factor apart
  Vec3 emission{0};         ///< Material::emission
};

struct SceneState {
  std::uint64_t environment = 0;  ///< hash; 0 = black
  std::vector<PunctualLight> lights;
  std::vector<ObjectState> objects;
  /// The objects in the same order, with their meshes (positions and normals only) and plainMaterial(): what
  /// stands for those of them that a later state no longer has.
  Scene plain;
};

/// By the means of its textures, without layers, films and directions: nearly the light that it reflects and
/// lets through, in nearly the same directions. A cut-out becomes a veil of its mean alpha.
Material plainMaterial(const Scene& scene, const Material& material);

/// Of a loaded scene, charted or not: the same.
SceneState sceneState(const Scene& scene);

}  // namespace saccade::core
