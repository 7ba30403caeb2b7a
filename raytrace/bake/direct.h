// Direct irradiance per texel: shadow rays from points spread over the texel's covered area.
//
// Where lamps are few (few_lamps.h) their unshadowed irradiance is exact at every point, so that light in the
// open carries no noise but that of the points, at any distance from a lamp; else lamps are sampled
// (many_lights.h), and so is the environment always. A texel whose samples disagree gets more of them.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/bake/few_lamps.h"
#include "raytrace/bake/open_area.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct DirectOptions {
  int samples = 16;    ///< per texel and side; best a power of 2
  int refinement = 4;  ///< up to so many times as many samples where they disagree (penumbrae, shadow edges)
  float relativeError = 0.02f;  ///< standard error of the mean that a texel is refined down to
  /// Samples of a texel that look at all lamps where lamps are few, at least; see few_lamps.h.
  int wholePoints = std::numeric_limits<int>::max();
  /// All cells of a texel use the same random numbers: what differs between them is their light, not noise.
  bool alike = false;
  std::uint32_t seed = 1;
  int threads = 0;                                ///< 0 = inline
  const std::vector<char>* keptCharts = nullptr;  ///< by chart: its texels are left alone; null: none
  RayCounters* counters = nullptr;  ///< with `threads` 0: counts the rays, and logs them where it has a log
};

struct DirectEstimate {
  Vec3 irradiance{0};  ///< W/m^2
  /// Of the luminance of `irradiance`, from the spread of the samples. They lie more evenly than that takes
  /// for granted, so it is a bound on average (found: 3/4 of it); samples that agree by chance state 0.
  float variance = 0;
};

/// Direct light of a texel or a cell of one.
struct CellLight {
  bool surface = false;  ///< it holds some
  bool open = false;     ///< some that nothing lies over
  DirectEstimate light;  ///< mean over that
};

/// Direct light at one place of the atlas after another; at() from any thread. All that it is made of must
/// outlive it.
class DirectLight {
 public:
  DirectLight(const World& world, const TexelMap& texels, const OpenArea& open, const DirectOptions& options);

  /// The texel must have open surface; the cell may have none.
  CellLight at(std::size_t texel, int layer, const TexelCell& cell) const;

 private:
  const World& world_;
  const TexelMap& texels_;
  const OpenArea& open_;
  DirectOptions options_;
  std::optional<FewLamps> few_;  ///< none: lamps are many
};

/// For the texels of `blocks`: out[texel] = mean over the texel's open area of the light that arrives
/// straight from lights (through alpha-blended surfaces too) at its front (layer 0) or back (layer 1,
/// double-sided charts only), W/m^2, against the interpolated normal. Texels without are left alone.
/// `open` must hold what it finds in these blocks.
/// Same bits for any number of threads and any ranges. Returns the first block that was not done, for a stop
/// was requested; all before it are.
std::size_t directIrradiance(const World& world, const TexelMap& texels, const OpenArea& open, int layer,
                             BlockRange blocks, const DirectOptions& options, const core::Progress& progress,
                             std::span<DirectEstimate> out);

}  // namespace saccade::raytrace
