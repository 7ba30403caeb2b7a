// What shines in a scene, apart from all else that illumination maps depend on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::core {

/// Enough of one state of a scene's lights to see what a change of them can do.
struct LightState {
  std::uint64_t unlitKey = 0;  ///< unlitSceneKey of the scene
  std::vector<PunctualLight> lights;
  std::vector<Vec3> emission;  ///< Material::emission, by material
};

/// sceneKey (maps.h) without punctual lights and materials' emission factors.
std::uint64_t unlitSceneKey(const Scene& scene);
LightState lightState(const Scene& scene);

}  // namespace saccade::core
