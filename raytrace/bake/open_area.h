// Which part of each texel's surface is open to light. A floor under a table's leg and the wall behind a
// picture are surface too, but nothing lights or shows them; where their border crosses a texel, the mean
// over all of it would be too dark for the part that is seen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// Something opaque lies over the point: along the normal, within `distance` or from within a closed body.
bool isCovered(const World& world, const Surface& at, float distance, RayCounters& counters);

/// Found by blocks of texels; then read by any thread.
class OpenArea {
 public:
  /// None so far.
  OpenArea(const TexelMap& texels, int layers);

  /// Probes some points of the texels of `blocks`, more where they disagree. Same bits for any number of
  /// threads and any ranges. Returns the first block that was not done, for a stop was requested; all before
  /// it are.
  std::size_t probe(const World& world, const TexelMap& texels, int layer, BlockRange blocks, int threads,
                    const core::Progress& progress);

  /// By texel, m^2: of what TexelMap::area says. Layer 1: backs; 0 for those of single-sided charts. A texel
  /// that is covered wholly has none.
  std::span<const float> areas(int layer) const { return areas_[layer]; }
  std::span<float> areas(int layer) { return areas_[layer]; }  ///< to go on from an earlier probe()
  /// How near something must be to cover a point of the texel, metres.
  static float reach(const TexelMap& texels, std::size_t texel);

 private:
  std::vector<float> areas_[2];
};

}  // namespace saccade::raytrace
