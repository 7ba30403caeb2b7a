// Error against seconds, and the seconds to an error.
#pragma once

#include <optional>
#include <vector>

namespace saccade::bench {

struct CurvePoint {
  double seconds = 0, error = 0;  ///< both > 0
};

struct Reached {
  double seconds = 0;
  bool atMost = false;  ///< the cheapest point is good enough already: what is below it was not measured
};

/// Where a curve, its points in any order, first comes down to `error`: a straight line between the
/// logarithms of its points, as noise that halves with every doubling of the time is. Nothing where no point
/// comes down to it.
std::optional<Reached> secondsToError(std::vector<CurvePoint> curve, double error);

}  // namespace saccade::bench
