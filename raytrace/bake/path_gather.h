// Illumination maps by path tracing from every texel: what the baker is measured against.
#pragma once

#include <cstdint>
#include <span>

#include "core/progress.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/path_tracer.h"

namespace saccade::raytrace {

struct PathGatherOptions {
  std::uint64_t firstPath = 0;  ///< index of a texel's first path: calls that follow on one another add up
  std::uint64_t paths = 1;      ///< a texel
  int bounces = 64;
  std::uint32_t seed = 1;
  int threads = 0;  ///< 0 = inline
};

/// Adds to sums[texel] the irradiance (W/m^2) of `paths` paths with next-event estimation (irradiancePath),
/// each from a point of its own, spread evenly over the texel's covered area: fronts in layer 0, backs of
/// double-sided charts in layer 1. Texels without surface are left alone. sums / (number of paths) is an
/// unbiased estimate of the texel's mean irradiance. Same bits for any number of threads. Throws core::Error
/// when stopped; the sums are then not to be used.
void gatherPaths(const World& world, const TexelMap& texels, int layer, const PathGatherOptions& options,
                 const core::Progress& progress, std::span<Vec3> sums);

}  // namespace saccade::raytrace
