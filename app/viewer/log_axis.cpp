#include "app/viewer/log_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::app {

namespace {

constexpr std::array<double, 3> kRound{1, 2, 5};
constexpr double kSlack = 1e-9;  // of a value that is a tick itself

/// Number n of the rounded values ..., 0.5, 1, 2, 5, 10, ..., with number 0 = 1.
double roundValue(int n) {
  const int decade = n >= 0 ? n / 3 : -((2 - n) / 3);
  return kRound[static_cast<std::size_t>(n - 3 * decade)] * std::pow(10.0, decade);
}

int roundBelow(double value) {
  int n = 3 * static_cast<int>(std::floor(std::log10(value))) + 3;
  while (roundValue(n) > value * (1 + kSlack)) --n;
  return n;
}

int roundAbove(double value) {
  const int below = roundBelow(value);
  return roundValue(below) < value * (1 - kSlack) ? below + 1 : below;
}

}  // namespace

double LogAxis::at(double value) const {
  if (!(value > low)) return 0;
  return std::min(1.0, std::log(value / low) / std::log(high / low));
}

std::vector<double> LogAxis::ticks(std::size_t atMost) const {
  const int first = roundAbove(low), last = roundBelow(high);
  std::vector<double> found;
  for (int n = first; n <= last; ++n) found.push_back(roundValue(n));
  for (int decades = 1; found.size() > std::max<std::size_t>(2, atMost); ++decades) {
    found.clear();
    for (int n = first; n <= last; ++n) {
      if (n % (3 * decades) == 0) found.push_back(roundValue(n));
    }
  }
  return found;
}

LogAxis axisAround(const std::vector<double>& values) {
  double smallest = HUGE_VAL, largest = 0;
  for (const double v : values) {
    if (v > 0) smallest = std::min(smallest, v);
    largest = std::max(largest, v);
  }
  if (!(largest > 0)) return {0.1, 1};
  const int high = roundAbove(largest);
  return {roundValue(std::min(roundBelow(smallest), high - 3)), roundValue(high)};
}

}  // namespace saccade::app
