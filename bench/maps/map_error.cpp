#include "bench/maps/map_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace saccade::bench {
namespace {

/// Sums over some of the points.
struct Sums {
  double reference = 0, found = 0, squares = 0, variance = 0;
  std::size_t count = 0;

  void add(double e, const PointTruth& truth) {
    const double r = core::luminance(truth.irradiance);
    reference += r;
    found += e;
    squares += (e - r) * (e - r);
    variance += truth.variance;
    ++count;
  }
  double relative() const {
    if (!(reference > 0)) return 0;
    const auto n = static_cast<double>(count);
    return std::sqrt(std::max(0.0, squares - variance) / n) / (reference / n);
  }
};

bool lit(const PointTruth& truth) { return truth.irradiance != core::Vec3(0); }

}  // namespace

MapError errorOf(std::span<const core::Vec3> found, std::span<const PointTruth> truth) {
  assert(found.size() == truth.size());
  Sums all, lits;
  std::vector<double> off;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double e = core::luminance(found[i]);
    all.add(e, truth[i]);
    if (!lit(truth[i])) continue;
    lits.add(e, truth[i]);
    off.push_back(std::abs(e - double{core::luminance(truth[i].irradiance)}));
  }
  MapError error;
  error.lit = lits.count;
  error.dark = all.count - lits.count;
  if (!(lits.reference > 0)) return error;
  error.relative = lits.relative();
  error.withDark = all.relative();
  error.bias = lits.found / lits.reference - 1;
  const auto rank = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(off.size() - 1));
  std::nth_element(off.begin(), off.begin() + rank, off.end());
  error.p99 = off[static_cast<std::size_t>(rank)] / (lits.reference / static_cast<double>(lits.count));
  return error;
}

double noiseOf(std::span<const PointTruth> truth) {
  Sums lits;
  for (const PointTruth& t : truth) {
    if (lit(t)) lits.add(0, t);
  }
  if (!(lits.reference > 0)) return 0;
  const auto n = static_cast<double>(lits.count);
  return std::sqrt(lits.variance / n) / (lits.reference / n);
}

}  // namespace saccade::bench
