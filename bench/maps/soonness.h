// How much sooner one way to maps is as near to the truth as another.
#pragma once

#include <vector>

#include "bench/harness/record.h"
#include "bench/peers/curve.h"

namespace saccade::bench {

/// seconds_ours, seconds_gather and time_over_gather at an error: along straight lines between the logarithms
/// of each curve's points (secondsToError). Where the gather does not get there, its longest seconds stand
/// for it, so that the quotient is an upper bound; where ours does not, there are no values. Label "status"
/// says so. Neither key nor scene. Pure; `gather` has at least one point.
Record soonness(const std::vector<CurvePoint>& ours, const std::vector<CurvePoint>& gather, double error);

}  // namespace saccade::bench
