// Finer texels where direct light steps (core::MapDetail): their direct light by shadow rays of their own.
// What else arrives is smooth and taken from the atlas, but for what near surfaces hide and send: in a corner
// or a gap, indirect light differs from cell to cell by the open share of the hemisphere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/map_detail.h"
#include "core/progress.h"
#include "raytrace/bake/detail_plan.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/gather.h"
#include "raytrace/bake/imported_light.h"
#include "raytrace/bake/kept.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// One cell as traced.
struct TracedCell {
  Vec3 direct{0};  ///< W/m^2; negative where there is no open surface
  NearLight near;
};

/// The stages of a bake that find the cells' light. One thread owns it.
class DetailLight {
 public:
  /// Of a bake's work: pieces that it can pause after, however many blocks there are.
  static constexpr std::uint64_t kPieces = 1024;

  /// Room for goal.mostTexels. What it refers to must outlive it.
  DetailLight(const World& world, const TexelMap& texels, const OpenArea& open, int layers,
              const DetailGoal& goal);

  /// probeEdges, and the probes so far.
  std::size_t probe(std::span<const LayerLight> layers, const DirectOptions& options, BlockRange blocks,
                    const core::Progress& progress);
  std::span<EdgeProbe> probes() { return probes_; }

  /// Chooses the texels by the probes, which must be complete, unless that was done. `kept` (null: none): its
  /// blocks are to have room beside.
  void plan(std::span<const LayerLight> layers, const KeptCharts* kept);

  /// Pieces [first, last); returns the first that was not done, for a stop was requested (at least one is).
  /// Same bits for any number of threads and any ranges. Needs a plan.
  /// `source`: what rays to near surfaces look up.
  std::uint64_t trace(std::uint64_t first, std::uint64_t last, const TexelLight& source,
                      const DirectOptions& options, const core::Progress& progress);
  /// All that was traced, for checkpoints.
  std::span<TracedCell> cells() { return cells_; }

  /// Blocks with their borders, traced and completed. `indirect` by layer: what the atlas holds beside direct
  /// light, gutters filled; `irradiance` by layer: all that it holds. `kept` (null: none): blocks of its
  /// charts stay as they were. `imported` (null: none): objects that show its light have no blocks.
  core::MapDetail finish(std::span<const std::vector<Vec3>> indirect,
                         std::span<const std::vector<Vec3>> irradiance, const KeptCharts* kept,
                         const ImportedLight* imported) const;

 private:
  const World& world_;
  const TexelMap& texels_;
  const OpenArea& open_;
  int layers_;
  DetailGoal goal_;
  std::vector<EdgeProbe> probes_;
  std::optional<std::vector<DetailTexel>> plan_;
  std::vector<std::size_t> first_;  ///< by block: of its cells in cells_, layer by layer
  std::vector<TracedCell> cells_;
};

}  // namespace saccade::raytrace
