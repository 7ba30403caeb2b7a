// A logarithmic axis: its ends and its ticks.
#pragma once

#include <vector>

namespace saccade::app {

/// From `low` to `high`, 0 < low < high.
struct LogAxis {
  double low = 1, high = 10;

  /// 0 at low, 1 at high; values beyond the ends (0 too) stay there.
  double at(double value) const;
  /// Growing, within the axis, at most `atMost` (at least 2): 1, 2 and 5 times powers of ten where they are
  /// few enough, else powers of ten, else every second of these, and so on.
  std::vector<double> ticks(std::size_t atMost) const;
};

/// The tightest axis between 1, 2 or 5 times powers of ten around the positive ones of the values, a factor
/// of ten long at least; 0.1 to 1 where there are none.
LogAxis axisAround(const std::vector<double>& values);

}  // namespace saccade::app
