// Unbiased path tracing of the whole scene: the reference for everything else. Next-event estimation and BSDF
// sampling joined by the power heuristic (Veach 1997), Russian roulette, box filter of one pixel.
#pragma once

#include <cstdint>

#include "core/camera.h"
#include "core/image.h"
#include "core/progress.h"
#include "raytrace/bsdf.h"
#include "raytrace/surface_points.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

enum class Transport {
  all,     ///< every lobe
  diffuse  ///< what base layer and maps claim: emission and Lambert with the base layer's diffuse factor
};

/// Part of the keys under which path-traced references are kept: raise it whenever the radiance of any path
/// changes.
inline constexpr int kPathTracerVersion = 2;

struct PathOptions {
  int samplesPerPixel = 64;
  /// Index of a pixel's first sample. Passes whose samples follow on one another add up to the picture of one
  /// pass with all of them.
  std::uint64_t firstSample = 0;
  int bounces = 12;  ///< scattering events; 0 = emission only, 1 = direct light
  Transport transport = Transport::all;
  DiffuseModel diffuse = DiffuseModel::lambert;  ///< with Transport::all
  std::uint32_t seed = 1;
  int threads = 0;        ///< 0 = on the calling thread
  bool variance = false;  ///< fill PathResult::variance
};

struct PathResult {
  core::ImageRgb radiance;
  core::ImageRgb variance;  ///< of the pixel's mean, per channel
  RayCounters counters;
};

/// The same image for any number of threads. Throws core::Error when stopped.
PathResult tracePaths(const World& world, const core::View& view, const PathOptions& options,
                      const core::Progress& progress);

/// Radiance along one ray (unit direction), for tests: the mean of options.samplesPerPixel paths.
Vec3 pathRadiance(const World& world, const Ray& ray, const PathOptions& options, RayCounters& counters);

/// The irradiance that maps are measured against.
struct IrradianceEstimate {
  Vec3 mean{0};      ///< W/m^2
  Vec3 variance{0};  ///< of the mean, per channel; unbiased
};

/// Light that arrives at a point of a surface by paths of every kind that this tracer finds (a point light's
/// caustics through smooth glass and mirrors are not among them), against the interpolated normal;
/// options.samplesPerPixel paths in 16 groups (rounded up), each from its sample options.firstSample on.
/// `stream` tells points apart. Any thread.
IrradianceEstimate pathIrradiance(const World& world, const SurfacePoint& at, std::uint32_t stream,
                                  const PathOptions& options, RayCounters& counters);

/// One such path, W/m^2: sample options.firstSample of `stream`, which shares no number with those of
/// pathIrradiance. Its mean over all samples is the irradiance; a path that is not finite is 0. Any thread.
Vec3 irradiancePath(const World& world, const SurfacePoint& at, std::uint32_t stream,
                    const PathOptions& options, RayCounters& counters);

}  // namespace saccade::raytrace
