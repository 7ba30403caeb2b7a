// Timing that can be believed: warm-up, repeats in alternating order, median and range, ratios within one
// run.
#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <functional>
#include <stop_token>
#include <vector>

namespace saccade::bench {

/// Every figure with a time is the median of at least so many.
inline constexpr int kRepeats = 5;

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Wall seconds of one call.
template <class F>
double timed(F&& f) {
  const Clock::time_point start = Clock::now();
  f();
  return secondsSince(start);
}

/// Lower median and range of at least one value.
struct Spread {
  double median = 0, min = 0, max = 0;
};
inline Spread spread(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  return {values[(values.size() - 1) / 2], values.front(), values.back()};
}

/// Calls measure(variant, round) for each of `variants` in each of `rounds` rounds, in ascending order in
/// even rounds and descending in odd ones, so that drift of the machine falls on all alike. Round -1 comes
/// first: the warm-up, whose figures are to be thrown away. Throws core::Error between two calls once a stop
/// is requested.
void alternate(int variants, int rounds, const std::stop_token& stop,
               const std::function<void(int variant, int round)>& measure);

/// a[i] / b[i], round by round; equal sizes.
std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace saccade::bench
