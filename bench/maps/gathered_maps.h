// The yardstick for the baker: maps of the same atlas by path tracing from every texel.
#pragma once

#include <cstdint>
#include <vector>

#include "app/session/workspace.h"
#include "core/maps.h"
#include "core/progress.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::bench {

/// Path-traced maps (raytrace/bake/path_gather.h) that grow better: the same charts, tracer and threads as
/// the bake, gutters filled by the same function, nothing smoothed. Main thread; starts threads of its own.
class GatheredMaps {
 public:
  /// `opened`: a workspace with its maps, whose charts are used and whose light is not.
  GatheredMaps(const app::Workspace& opened, std::uint32_t seed, int threads);

  /// Traces paths until every texel has `paths` of them; returns the seconds since the first one. Throws
  /// core::Error when stopped.
  double growTo(std::uint64_t paths, const core::Progress& progress);

  std::uint64_t paths() const { return paths_; }
  double seconds() const { return seconds_; }
  /// With gutters, as halves; their seconds are added to `seconds`.
  core::IlluminationMaps maps(double& seconds) const;

 private:
  const app::Workspace& opened_;
  raytrace::TexelMap texels_;
  std::uint32_t seed_;
  int threads_;
  std::uint64_t paths_ = 0;
  double seconds_ = 0;
  std::vector<std::vector<core::Vec3>> sums_;  ///< by layer
};

}  // namespace saccade::bench
