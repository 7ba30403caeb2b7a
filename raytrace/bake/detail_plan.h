// Which texels of the atlas are cut into finer cells (core::MapDetail), and how finely: those in which direct
// light steps, across the step.
//
// The error that a straight step leaves in bilinear look-ups falls with the first power of the texel's side,
// so that texels of one size in a chart make the error of the whole map fall with the fourth root of their
// number only; cells that are fine along the step make it fall with the square root, and with the first power
// where the step runs along the cells, as most do in buildings.
//
// Probed are texels that differ from the line between their neighbours, that something covers in part, or
// whose chart is too narrow to tell: 4 x 4 cells of few samples, and products of second differences of these
// along u and v from two independent sets of samples, so that their noise does not count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/map_detail.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

struct DetailGoal {
  double relativeError = 0.02;  ///< wished for: root mean square of what look-ups miss of it, over its mean
  std::size_t mostTexels = 0;   ///< of all blocks with their borders; comes before the error. 0: no detail
};

/// What look-ups of one texel miss of direct light, squared, times the open area of its layers, (W/m)^2.
struct EdgeProbe {
  /// By steps across u and across v: with cells of a share h of the texel h times as much is left.
  float stepU = 0, stepV = 0;
  /// By what look-ups mix in from the texels beside, where light is another; by slopes across charts that are
  /// one texel wide: nothing is left with two cells.
  float besideU = 0, besideV = 0;
};

/// Direct light of one layer, as directIrradiance found it, and where it is open (OpenArea::areas).
struct LayerLight {
  std::span<const DirectEstimate> direct;
  std::span<const float> open;
  const std::vector<char>* keptCharts = nullptr;  ///< by chart: `direct` was not found there; null: none
};

/// Probes all texels of `blocks` that may need cells; out[texel]. `options` as for directIrradiance. Same
/// bits for any number of threads and any ranges. Returns the first block that was not done, for a stop was
/// requested; all before it are.
std::size_t probeEdges(const World& world, const TexelMap& texels, const OpenArea& open,
                       std::span<const LayerLight> layers, const DetailGoal& goal,
                       const DirectOptions& options, BlockRange blocks, const core::Progress& progress,
                       std::span<EdgeProbe> out);

/// One texel of the atlas that has a block; of this the size only is meant until it has its place.
struct DetailTexel {
  std::uint32_t texel = 0;
  core::MapBlock block;
};

/// By texel, ascending. Cells cost texels, borders included, and save error: the same error for a texel
/// everywhere (Lagrange).
std::vector<DetailTexel> planDetail(const TexelMap& texels, std::span<const LayerLight> layers,
                                    std::span<const EdgeProbe> probes, const DetailGoal& goal);

}  // namespace saccade::raytrace
