// Final gathering: indirect light per texel by rays that look up, where they end, the light that is already
// known there (Reichert 1992; Jensen 1996, "Global Illumination using Photon Maps"). One more bounce than
// particles have, so their noise and the blur of their kernel are averaged over all that a texel sees.
//
// Rays go through the surface's own tracer: from a texel by the cosine, on through all lobes but Lambert's,
// until these have nothing left. At every surface on the way the diffuse lobe is looked up. What shines is
// not added: seen from the texel directly it is direct light (direct.h), by way of specular surfaces the
// particles bring it (ParticleState::caustic). So each path of light is counted once:
//   light -> texel (direct), light -> specular -> texel (caustic), ... -> diffuse -> specular* -> texel
//   (here).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/open_area.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// All light that arrives at the surfaces, as far as it is known, W/m^2: by layer (0 front, 1 back of
/// double-sided charts; may be absent) and texel. Gutters must be filled.
struct TexelLight {
  std::vector<Vec3> layers[2];
};

struct GatherOptions {
  int rays = 16;  ///< per texel and side; a power of two spreads them best over neighbouring texels
  std::uint32_t seed = 1;
  int threads = 0;                                ///< 0 = inline
  const std::vector<char>* keptCharts = nullptr;  ///< by chart: its texels are left alone; null: none
  RayCounters* counters = nullptr;  ///< with `threads` 0: counts the rays, and logs them where it has a log
};

/// For the texels of `blocks`: out[texel] = mean over the texel's open area of the light that diffuse
/// surfaces send to its front (layer 0) or back (layer 1, double-sided charts only), by way of specular ones
/// too, W/m^2, against the interpolated normal; with the variance of that mean. Texels without surface are
/// left alone. Same bits for any number of threads and any ranges. Returns the first block that was not done,
/// for a stop was requested; all before it are.
std::size_t gatherIrradiance(const World& world, const TexelMap& texels, const OpenArea& open, int layer,
                             BlockRange blocks, const TexelLight& source, const GatherOptions& options,
                             const core::Progress& progress, std::span<DirectEstimate> out);

/// Indirect light at one place, parted by how far it comes.
struct NearLight {
  Vec3 irradiance{0};  ///< W/m^2, by what is met within the reach, and all that comes by way of it
  float open = 1;      ///< share of the hemisphere, by the cosine, in which nothing is met
};

/// Mean over the open surface of a cell of a texel, by `options.rays` rays; `reach` in metres. Nothing is
/// near where the cell has no open surface.
NearLight nearLight(const World& world, const TexelMap& texels, std::size_t texel, const TexelCell& cell,
                    int layer, float reach, const TexelLight& source, const GatherOptions& options);

}  // namespace saccade::raytrace
