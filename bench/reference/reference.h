// Path-traced pictures of still views, which everything else is measured against: computed once, to a stated
// confidence, and kept.
//
// A reference is the mean of two independent halves, made and kept as kept_sums.h says, until its estimated
// relative MSE is low enough. Beside the sums, for people and other programs: <key>.exr, the picture, and
// <key>.json, what it is a picture of and how good it is.
#pragma once

#include <cstdint>

#include "app/cli/options.h"
#include "app/session/workspace.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/metrics/comparison.h"
#include "core/progress.h"
#include "raytrace/path_tracer.h"

namespace saccade::bench {

/// What a reference is a picture of.
struct ReferenceView {
  core::Camera camera;
  app::ImageSize size;
  raytrace::Transport transport = raytrace::Transport::all;
  raytrace::DiffuseModel diffuse = raytrace::DiffuseModel::lambert;
  int bounces = 12;
  std::uint32_t seed = 1;  ///< hashed: no sample is shared with a picture under test, whatever its seed
};

/// How good it has to be.
struct Confidence {
  double relmse = 1e-3;     ///< estimated relative MSE (core/metrics) of the reference itself
  double capSeconds = 100;  ///< SumsTask::capSeconds
};

struct Reference {
  std::uint64_t key = 0;
  core::ImageRgb radiance;
  /// The estimated error of `radiance`: what the true picture would score against it, the floor below which
  /// no difference from it means anything. It compares the mean of the halves with one of them, since their
  /// difference is distributed as the mean's own error is. RMSE is unbiased; relative MSE is while a pixel's
  /// error is small against its value (bright paths so rare that neither half met one are in no estimate).
  /// SSIM and FLIP are those of a picture that is off by as much, but noisier than the true one.
  core::Comparison own;
  std::uint64_t samplesPerPixel = 0;
  double seconds = 0;    ///< of computing, as Confidence::capSeconds counts them
  bool reached = false;  ///< the confidence that was asked for
};

/// Hash of the scene's content, the view, the size, the transport, the seed and the path tracer's version.
std::uint64_t referenceKey(const core::Scene& scene, const ReferenceView& view);

/// From the cache where it is good enough, else computed with `threads` threads (0 = on the calling one),
/// going on from what is there. A cache folder that cannot be written is done without; `warnings` says so.
/// Throws core::Error when stopped, after keeping what
/// was done.
Reference computeReference(const app::Workspace& workspace, const ReferenceView& view,
                           const Confidence& confidence, int threads, const core::Progress& progress,
                           core::Warnings& warnings);

/// The same on all cores, with a progress bar and with warnings printed, one of them where the confidence was
/// not reached.
Reference referenceOf(const app::Workspace& workspace, const ReferenceView& view,
                      const Confidence& confidence, const std::stop_token& stop);

}  // namespace saccade::bench
