#include "bench/peers/curve.h"

#include <algorithm>
#include <cmath>

namespace saccade::bench {

std::optional<Reached> secondsToError(std::vector<CurvePoint> curve, double error) {
  std::sort(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  const auto good =
      std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& p) { return p.error <= error; });
  if (good == curve.end()) return std::nullopt;
  if (good == curve.begin()) return Reached{good->seconds, good->error < error};
  const CurvePoint a = *(good - 1), b = *good;
  const double part = std::log(a.error / error) / std::log(a.error / b.error);
  return Reached{a.seconds * std::pow(b.seconds / a.seconds, part), false};
}

}  // namespace saccade::bench
