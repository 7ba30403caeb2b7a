// Maps that were baked before the lights of a scene changed: what of them can stay is not baked again.
//
// A note in the cache folder says, for a scene file and settings, where its newest maps are and which lights
// they were baked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/maps.h"
#include "core/scene/scene.h"
#include "raytrace/bake/kept_charts.h"

namespace saccade::app {

struct EarlierMaps {
  core::IlluminationMaps maps;
  raytrace::EarlierLight light;
};

/// The newest maps that were baked from this scene file with these settings (which tell maps of one scene
/// apart), when nothing but lights has changed since; said, when more has. None when lights are the same,
/// too.
std::optional<EarlierMaps> earlierMaps(const core::Scene& scene, const std::string& settings);

/// Notes that `file` holds this scene's newest maps. `drift`: raytrace::EarlierLight. Failures only make a
/// later bake longer.
void rememberMaps(const core::Scene& scene, const std::string& settings, const std::filesystem::path& file,
                  double drift);

}  // namespace saccade::app
