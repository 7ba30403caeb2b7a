// Particle density to irradiance: a kernel whose width follows the local density and the light itself.
//
// In each chart flux and open area are summed over square windows of texels (summed-area tables), and
// irradiance is their quotient at the window's centre, by a plane through the quotients of the window's
// parts. Only area that is there is counted, so nothing darkens towards chart borders, and the plane takes
// out the slope that a window cut by a border would otherwise mistake for level. A window grows while its
// estimate agrees, within its own statistical error, with those of all smaller ones (the intersection of
// confidence intervals, Goldenshluger and Nemirovski 1997): where light is even the window is wide and noise
// small; at a shadow's or caustic's edge, or at the foot of a wall with a dark room behind, it stops.
//
// Light through walls (light_leak_test.cpp), as a share of what is before the wall: the texel that a wall
// thinner than itself crosses holds the light of both sides, and bilinear look-ups show that up to 1.5 texels
// behind the wall. Further on direct light stays below 1 %, and is nothing from 3 texels on or behind a wall
// that covers a texel. Windows that reach across, and gather rays that meet the crossed texel, leave less
// than 2 % of all light up to 3 texels behind a thin wall and half a percent beyond; 1 % behind a thick one.
#pragma once

#include <span>

#include "core/progress.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

struct DensityOptions {
  float confidence = 2.2f;  ///< half width of the confidence intervals in standard errors
  double enough = 4000;     ///< (mean / standard error)^2 beyond which a window does not grow: 1.6 % noise
  double doubt = 1;         ///< added to the sum of squared weights: so many particles may have been missed
  int maxRadius = 96;       ///< texels
  /// The variance of windows smaller than this is at least that of one so wide, in proportion: that of few
  /// samples is itself a sample, and those that missed something bright would pass for sure.
  int pooledRadius = 0;
  int threads = 0;  ///< 0 = inline
};

/// One texel's estimate.
struct DensityEstimate {
  Vec3 irradiance{0};        ///< W/m^2
  float relativeError = -1;  ///< one standard error of the luminance over itself; -1 where no particle came
};

/// Flux that stands for per-texel estimates with errors of their own, so that direct light's noise is
/// smoothed by the same rule: weight = irradiance x area (m^2, by texel) / `watts` (returned). For
/// estimateDensity with doubt 0.
FluxGrid fluxOf(std::span<const float> areas, std::span<const DirectEstimate> direct, double& watts);

/// Estimates by one plane of `flux` for all texels with `areas` (m^2: OpenArea); others are left alone.
/// `watts`: wattsPerWeight. Same bits for any number of threads. Throws core::Error when stopped.
void estimateDensity(const TexelMap& texels, std::span<const float> areas, const FluxGrid& flux, int plane,
                     double watts, const DensityOptions& options, const core::Progress& progress,
                     ProgressShare share, std::span<DensityEstimate> out);

}  // namespace saccade::raytrace
