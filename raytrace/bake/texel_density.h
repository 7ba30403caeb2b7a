// How fine each chart's texels are: where direct light varies, for as many texels as there may be.
//
// With texels of side h a chart's look-ups miss about kMissed D(h) in the square, D its structure function
// (light_variation.h), fitted by a power k h^p. The smallest number of texels for a summed square error, and
// the smallest error for a number of texels, both have the same slope of error by texels in every chart
// (Lagrange): h = (2 mu R / (A k p))^(1 / (p + 2)), with A the chart's area and R its rectangle's.
#pragma once

#include <span>
#include <vector>

#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/light_variation.h"

namespace saccade::raytrace {

struct DensityGoal {
  /// Wished for: root mean square of what texels miss of direct light, over its mean.
  double relativeError = 0.02;
  double mostTexels = 1 << 20;      ///< rectangles and borders; comes before the error
  double coarsest = 1, finest = 0;  ///< metres
};

struct DensityChoice {
  std::vector<double> texelMetres;  ///< by item
  double relativeError = 0;         ///< expected
};

/// `variation` by item of the layout, measured at `metres`. Where not even the coarsest texels are few enough
/// all grow alike.
DensityChoice chooseDensity(ChartLayout& layout, std::span<const LightVariation> variation,
                            std::span<const double> metres, const DensityGoal& goal);

}  // namespace saccade::raytrace
