// What the qualities of a bake stand for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace saccade::raytrace {

struct Quality {
  const char* name;
  /// Root mean square error over mean irradiance that is wished for. What changes of a scene leave of earlier
  /// maps goes by it too (kept_charts.h).
  double errorTarget;

  /// Of what look-ups of the atlas's texels miss of direct light, over its mean: texels are chosen by it.
  double texelError;
  double texels;    ///< of the atlas at most, the plan's cap apart: what the time of a bake goes by
  double coarsest;  ///< texels are as fine as this part of plan.coarsestTexel everywhere, for indirect light
  double detailTexels;  ///< of blocks (core::MapDetail) at most, a layer; 0: none
  double detailError;   ///< as texelError, with blocks

  std::uint64_t photons;  ///< particles of all kinds
  int causticShare;       ///< of 256 particles, those that are followed to the first diffuse surface only
  int directSamples;      ///< DirectOptions::samples
  int wholePoints;        ///< DirectOptions::wholePoints
  int gatherRays;         ///< of a texel; 0: particles' indirect light is shown as it is
  /// Of the smoothing of gathered light: the more evenly rays lie, the more their spread overstates the
  /// error.
  float gatherConfidence;
};

/// All, the quickest first.
std::span<const Quality> qualities();

/// Throws core::UsageError for an unknown name.
const Quality& qualityOf(const std::string& name);

}  // namespace saccade::raytrace
