// Particle density to irradiance: a kernel whose width follows the local density and the light itself.
//
// In each chart flux and covered area are summed over square windows of texels (summed-area tables), and
// irradiance is their quotient. Only area that is there is counted, so nothing darkens towards chart borders.
// A window grows while its estimate agrees, within its own statistical error, with those of all smaller ones
// (the intersection of confidence intervals, Goldenshluger and Nemirovski 1997): where light is even the
// window is wide and noise small; at a shadow's or caustic's edge, or at the foot of a wall with a dark room
// behind, it stops.
#pragma once

#include <span>

#include "core/progress.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

struct DensityOptions {
  float confidence = 1.6f;  ///< half width of the confidence intervals in standard errors
  double enough = 4000;     ///< effective particles beyond which a window does not grow (1.6 % noise)
  int maxRadius = 96;       ///< texels
  int threads = 0;          ///< 0 = inline
};

/// One texel's estimate.
struct DensityEstimate {
  Vec3 irradiance{0};        ///< W/m^2
  float relativeError = -1;  ///< one standard error of the luminance over itself; -1 where no particle came
};

/// Estimates for the layer's texels with surface; others are left alone. `watts`: wattsPerWeight. Same bits
/// for any number of threads. Throws core::Error when stopped.
void estimateDensity(const TexelMap& texels, const FluxGrid& flux, int layer, double watts,
                     const DensityOptions& options, const core::Progress& progress, ProgressShare share,
                     std::span<DensityEstimate> out);

}  // namespace saccade::raytrace
