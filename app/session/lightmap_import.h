// Lightmaps that another program baked, found by the names of the scene's nodes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/load_budget.h"
#include "core/scene/scene.h"
#include "raytrace/bake/imported_light.h"

namespace saccade::app {

/// What --import found, for the user.
struct LightmapReport {
  std::vector<std::string> taken;     ///< "FILE (512x512): node NAME, 4 objects"
  std::vector<std::string> baked;     ///< names of nodes without a lightmap that are baked
  std::vector<std::string> warnings;  ///< files that match no node, nodes without a second UV set
};

/// Reads NODE.lightmap.EXT or NODE.EXT of `folder` (.jpg, .jpeg, .png, .hdr, .exr; not below it) for every
/// node of that name. Irradiance = pi * value * scale: a value of 1 is what lights a white diffuse surface to
/// radiance 1. 8-bit images hold sRGB-encoded values, .hdr and .exr linear ones; values that are negative or
/// not finite count as 0. Throws core::Error when folder or image cannot be read, an image is broken, a node
/// has two images, nothing matches, or all images together cost more than `limits`; core::UsageError when
/// `scale` is not a positive number.
raytrace::ImportedLight readLightmaps(const std::filesystem::path& folder, const core::Scene& scene,
                                      float scale, const core::LoadLimits& limits, LightmapReport& report);

}  // namespace saccade::app
