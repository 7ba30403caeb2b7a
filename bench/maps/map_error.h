// How far illumination maps are from the irradiance that is really there.
#pragma once

#include <cstddef>
#include <span>

#include "core/math/types.h"

namespace saccade::bench {

/// What a point's irradiance really is, as far as the reference knows.
struct PointTruth {
  core::Vec3 irradiance{0};  ///< W/m^2
  double variance = 0;       ///< of its luminance, estimated without bias
};

/// All of the luminance, relative to the mean reference of the same points.
struct MapError {
  /// sqrt(max(0, mean((E - reference)^2) - mean variance)) / mean(reference), over points that some path of
  /// the reference brought light to; the others lie in closed bodies, where nobody looks and where a texel's
  /// mean over both sides of a wall is no error that shows.
  double relative = 0;
  double withDark = 0;  ///< the same over all points
  double bias = 0;      ///< mean(E) / mean(reference) - 1, lit points
  double p99 = 0;       ///< 99th percentile of |E - reference|, the reference's noise included; lit points
  std::size_t lit = 0, dark = 0;
};

/// `found`: what the maps hold at each point. Zeros where there is no light at all. Pure.
MapError errorOf(std::span<const core::Vec3> found, std::span<const PointTruth> truth);

/// sqrt(mean variance) / mean(reference) over lit points: what a perfect map would score before the
/// reference's variance is taken out. Pure.
double noiseOf(std::span<const PointTruth> truth);

}  // namespace saccade::bench
