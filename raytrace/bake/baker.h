// The illumination maps of a scene (Haber 2001, section 4): direct light by shadow rays per texel, indirect
// light and caustics by particle tracing with density estimation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/maps.h"
#include "core/progress.h"
#include "raytrace/bake/imported_light.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct BakeOptions {
  std::string quality = "medium";  ///< preview, medium or high
  std::uint64_t photons = 0;       ///< particles; 0 = as the quality says
  std::uint32_t seed = 1;
  int threads = 0;                          ///< 0 = all on the calling thread; the maps do not depend on it
  const ImportedLight* imported = nullptr;  ///< replaces what is baked for some objects; null: none
};

/// Particles that a quality stands for. Throws core::UsageError for an unknown name.
std::uint64_t photonsOf(const std::string& quality);

/// Irradiance of every texel, W/m^2, without albedo; gutters filled so that bilinear look-ups near chart
/// borders read no empty texel; `key` left 0 for the caller. `charts` and `atlasSize` come from makeCharts
/// and were applied to the world's scene (core::applyCharts); the charts are moved into the result. Layer 1
/// exists when some material that shows irradiance is double-sided. Progress from any of the threads. Throws
/// core::UsageError for an unknown quality, core::Error when stopped.
core::IlluminationMaps bakeMaps(const World& world, core::SceneCharts charts, int atlasSize,
                                const BakeOptions& options, const core::Progress& progress);

}  // namespace saccade::raytrace
