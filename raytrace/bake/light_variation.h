// How much direct light varies over a surface from one texel to the next: what decides where texels pay.
//
// Measured are second-order structure functions, D(d) = E[(E(x - d) - 2 E(x) + E(x + d))^2] over points x and
// directions of an item's surface: bilinear look-ups are exact where light is linear, so a first difference
// would ask for texels on every slope. The two factors of the square come from two independent sets of light
// samples, so that their noise does not count as light that varies; within a set all points use the same
// numbers, so that most noise cancels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

inline constexpr std::size_t kVariationDistances = 3;

struct LightVariation {
  double area = 0;        ///< m^2, both sides of double-sided surfaces
  double irradiance = 0;  ///< mean direct light, W/m^2
  /// D by distance, (W/m^2)^2, never negative; NaN where the surface has no room for a pair of points.
  std::array<double, kVariationDistances> structure{};
};

struct VariationOptions {
  std::size_t points = 24000;     ///< by area, and as many again by light: about fifty rays each
  std::size_t pointsPerItem = 4;  ///< beyond these
  std::array<double, kVariationDistances> metres{};  ///< descending
  std::uint32_t seed = 1;
  int threads = 0;  ///< 0 = inline; changes nothing of the result
};

/// By item of the layout. `texels` is the map of `layout` as packed in the world's scene. Throws core::Error
/// when stopped.
std::vector<LightVariation> measureVariation(const World& world, const TexelMap& texels,
                                             const ChartLayout& layout, const VariationOptions& options,
                                             const core::Progress& progress);

}  // namespace saccade::raytrace
