// Maps that were baked before a scene changed: what of them can stay is not baked again.
//
// A note in the cache folder says, for a scene file and settings, where its newest maps are and what the
// scene was like then (core/scene_state.h: 24 bytes a vertex, 12 a triangle).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/session/workspace.h"
#include "core/maps.h"
#include "core/scene/scene.h"
#include "raytrace/bake/kept_charts.h"

namespace saccade::app {

struct EarlierMaps {
  core::IlluminationMaps maps;
  raytrace::EarlierScene scene;
};

/// The newest maps that were baked from this scene file with these settings (which tell maps of one scene
/// apart), when it has changed since. None where the file was written anew since (with lightmaps of another
/// program, say) or the change is of a kind of which nothing can stay, that of the environment; both are
/// said. `state` is the scene's.
std::optional<EarlierMaps> earlierMaps(const core::Scene& scene, const core::SceneState& state,
                                       const std::string& settings);

/// Notes that `file` holds the newest maps of the opened scene. `drift`: raytrace::EarlierScene. Failures
/// only make a later bake longer.
void rememberMaps(const Workspace& opened, const core::SceneState& state, const std::string& settings,
                  const std::filesystem::path& file, double drift);

}  // namespace saccade::app
