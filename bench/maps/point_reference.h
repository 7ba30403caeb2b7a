// Path-traced irradiance at seeded points of a scene's surfaces, which illumination maps are measured
// against: computed once, to a stated confidence, and kept as the reference pictures are
// (bench/reference/kept_sums.h): a point is a pixel of a picture one row high.
#pragma once

#include <cstdint>
#include <vector>

#include "app/session/workspace.h"
#include "bench/maps/map_error.h"
#include "core/error.h"
#include "core/progress.h"
#include "raytrace/surface_points.h"

namespace saccade::bench {

/// What is computed; all of it is in the key.
struct PointTask {
  int points = 4096;
  int bounces = 64;        ///< the rest is below any noise: roulette leaves a twentieth a bounce at most
  std::uint32_t seed = 1;  ///< of points and paths; no number is shared with a bake
};

struct PointConfidence {
  double noise = 0.01;      ///< noiseOf the reference
  double capSeconds = 300;  ///< SumsTask::capSeconds
};

struct PointReference {
  std::uint64_t key = 0;
  std::vector<raytrace::SurfacePoint> points;
  /// The variance comes from two halves that share no random number: one degree of freedom a point.
  std::vector<PointTruth> truth;
  double noise = 0;
  std::uint64_t samplesPerPoint = 0;
  double seconds = 0;    ///< of computing, as capSeconds counts them
  bool reached = false;  ///< the confidence that was asked for
};

/// `scene` as it was loaded, before charts: what core::sceneKey is defined for. It holds positions in metres,
/// so another unit scale is another key.
std::uint64_t pointReferenceKey(const core::Scene& scene, const PointTask& task);

/// `uncharted`: of app::openWithoutMaps. From the cache where it is good enough, else computed with `threads`
/// threads (0 = on the calling one), going on from what is there. `warnings` says what was wrong with a file,
/// and that a cache folder cannot be written. Throws core::Error when stopped, after keeping what was done.
PointReference computePointReference(const app::Workspace& uncharted, const PointTask& task,
                                     const PointConfidence& confidence, int threads,
                                     const core::Progress& progress, core::Warnings& warnings);

/// The same on all cores, with a progress bar and with warnings printed, one of them where the confidence was
/// not reached.
PointReference pointReferenceOf(const app::Workspace& uncharted, const PointTask& task,
                                const PointConfidence& confidence, const std::stop_token& stop);

}  // namespace saccade::bench
