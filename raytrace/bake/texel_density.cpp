#include "raytrace/bake/texel_density.h"

#include <algorithm>
#include <cmath>

namespace saccade::raytrace {
namespace {

/// Of D(h): for a straight step, through texel means and bilinear look-ups (a quadratic B-spline), 0.2 h J^2
/// for each metre of step where D is (2 / pi) 2 h J^2. Smooth light misses less.
constexpr double kMissed = 0.16;
constexpr double kSmallestPower = 1, kLargestPower = 4;  // a step's, a curve's
constexpr double kBisections = 60;

/// D = factor * h^power, h in metres.
struct PowerLaw {
  double factor = 0, power = 2;
  double at(double h) const { return factor * std::pow(h, power); }
};

/// Raised where few probes met a step that those at other distances did: D neither falls with the distance
/// nor rises faster than kLargestPower. `metres` descend.
std::array<double, kVariationDistances> plausible(std::array<double, kVariationDistances> structure,
                                                  std::span<const double> metres, double floor) {
  double least = floor;
  for (std::size_t d = metres.size(); d-- > 0;)
    if (!std::isnan(structure[d])) structure[d] = least = std::max(structure[d], least);
  for (std::size_t d = 1; d < metres.size(); ++d)
    structure[d] =
        std::max(structure[d], structure[d - 1] * std::pow(metres[d] / metres[d - 1], kLargestPower));
  return structure;
}

/// Least squares in the logarithms. Values below `floor`, and what is missing, are taken for it.
PowerLaw fit(const LightVariation& v, std::span<const double> metres, double floor) {
  const std::array<double, kVariationDistances> structure = plausible(v.structure, metres, floor);
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t d = 0; d < metres.size(); ++d) {
    if (std::isnan(structure[d])) continue;
    const double lx = std::log(metres[d]), ly = std::log(structure[d]);
    ++n, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
  }
  PowerLaw out;
  if (n == 0) return {floor, 0};
  if (n > 1) out.power = std::clamp((n * xy - x * y) / (n * xx - x * x), kSmallestPower, kLargestPower);
  out.factor = std::exp((y - out.power * x) / n);
  return out;
}

struct Item {
  double area, rectangle;
  double edge;  ///< LayoutItem::edge
  PowerLaw law;
};

class Chooser {
 public:
  Chooser(ChartLayout& layout, std::span<const LightVariation> variation, std::span<const double> metres,
          const DensityGoal& goal)
      : layout_(layout), goal_(goal) {
    double flux = 0;
    for (const LightVariation& v : variation) {
      area_ += v.area;
      flux += v.area * v.irradiance;
    }
    mean_ = area_ > 0 ? flux / area_ : 0;
    const double floor = 1e-8 * mean_ * mean_;
    for (std::size_t i = 0; i < variation.size(); ++i) {
      items_.push_back({variation[i].area, layout.items()[i].rectangle, layout.items()[i].edge,
                        fit(variation[i], metres, floor)});
    }
  }

  DensityChoice choose() {
    // The multiplier's range: from the finest texels everywhere to the coarsest.
    double low = -80, high = 80;
    if (mean_ > 0) {
      // Where the finest texels cannot reach the error, no texels are spent on what hardly adds to it.
      constexpr double kNearly = 1.05;
      const double wanted = std::max(goal_.relativeError, kNearly * errorOf(sides(low)));
      high = bisect(low, high, [&](double m) { return errorOf(sides(m)) <= wanted; });
    }
    if (layout_.texelCount(sides(high)) > goal_.mostTexels) {
      high = -bisect(-80, -high, [&](double m) { return layout_.texelCount(sides(-m)) <= goal_.mostTexels; });
    }
    DensityChoice out{sides(high), 0};
    while (layout_.texelCount(out.texelMetres) > goal_.mostTexels && grows(out.texelMetres)) {
      for (double& h : out.texelMetres) h *= 1.05;
    }
    out.relativeError = errorOf(out.texelMetres);
    return out;
  }

 private:
  /// The largest value in [low, high] that holds, where small ones do; low when none does.
  template <class Holds>
  static double bisect(double low, double high, Holds&& holds) {
    if (holds(high)) return high;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(middle) ? low : high) = middle;
    }
    return low;
  }

  std::vector<double> sides(double logMultiplier) const {
    std::vector<double> out;
    out.reserve(items_.size());
    for (const Item& i : items_) {
      if (i.edge > 0) {
        out.push_back(i.edge);
        continue;
      }
      const double weight = i.area * i.law.factor * i.law.power;
      const double h =
          weight > 0 ? std::pow(2 * std::exp(logMultiplier) * i.rectangle / weight, 1 / (i.law.power + 2))
                     : goal_.coarsest;
      out.push_back(std::clamp(h, goal_.finest, goal_.coarsest));
    }
    return out;
  }

  double errorOf(const std::vector<double>& h) const {
    double sum = 0;
    for (std::size_t i = 0; i < items_.size(); ++i) sum += items_[i].area * kMissed * items_[i].law.at(h[i]);
    return area_ > 0 && mean_ > 0 ? std::sqrt(sum / area_) / mean_ : 0;
  }

  /// Some rectangle has more than one texel yet.
  bool grows(const std::vector<double>& h) const {
    for (std::size_t i = 0; i < h.size(); ++i) {
      if (h[i] < 2 * layout_.items()[i].largestExtent) return true;
    }
    return false;
  }

  ChartLayout& layout_;
  DensityGoal goal_;
  std::vector<Item> items_;
  double area_ = 0, mean_ = 0;
};

}  // namespace

DensityChoice chooseDensity(ChartLayout& layout, std::span<const LightVariation> variation,
                            std::span<const double> metres, const DensityGoal& goal) {
  return Chooser(layout, variation, metres, goal).choose();
}

}  // namespace saccade::raytrace
