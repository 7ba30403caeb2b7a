// Files to scenes: glTF 2.0 (.gltf, .glb) and OBJ + MTL.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/load_budget.h"
#include "core/scene/environment.h"
#include "core/scene/instances.h"
#include "core/scene/scene.h"

namespace saccade::core {

struct LoadOptions {
  float unitScale = 1;                     ///< file units to metres
  int scene = -1;                          ///< glTF scene index; -1 = the file's default
  double timeSeconds = 0;                  ///< at which animations are shown; finite, >= 0
  float nonDiffuseThreshold = 0.1f;        ///< --nondiffuse
  std::size_t sharingPays = kSharingPays;  ///< chooseInstances
  std::vector<std::string> lights;         ///< --light TYPE:key=value,... (see parseLight)
  LoadLimits limits;                       ///< what reading the file may cost
  std::string environment;                 ///< --environment FILE; empty = none
  EnvironmentOptions environmentOptions;
};

/// Whether a file's name ends like a scene's: .glb, .gltf or .obj, in small letters or capitals. Any thread.
bool isNamedAsScene(const std::filesystem::path& file);

/// Reads a scene, completes it (normals, clusters, ids, hierarchy, default light and camera, plan input) and
/// returns it. Throws core::Error naming file, element and rule. Repairs are counted in Scene::warnings. Any
/// thread.
Scene loadScene(const std::filesystem::path& file, const LoadOptions& options);

/// Everything after parsing, for scenes made in memory (tests, generators): clusters, closedness, ids,
/// bounds, hierarchy, default light and camera. Objects must hold mesh, material, name, node, primitive
/// (Scene::add, or an instanced mesh and meshToWorld). A `budget` is charged for copies of meshes, and stops
/// it when the time is up.
void completeScene(Scene& scene, const LoadOptions& options, LoadBudget* budget = nullptr);

/// Adds what one --light option describes: point:pos=x,y,z,power=r,g,b | spot:... |
/// directional:dir=..,irradiance=.. | panel:at=x,y,z,size=w,h,radiance=r,g,b (faces down unless dir= is
/// given). Throws core::UsageError with an example.
void addLight(Scene& scene, const std::string& description);

}  // namespace saccade::core
