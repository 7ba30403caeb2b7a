// Path-traced pictures of still views, which everything else is measured against: computed once, to a stated
// confidence, and kept.
//
// A reference is the mean of two independent halves (sums.h). Passes of a fixed number of samples are added
// until the estimated relative MSE of the mean is low enough, or until the time for it is used up. The sums
// lie in <cache folder>/references/<key>.sums, are written every few seconds and when a stop is requested,
// and are taken up again by the next run, so a stopped run loses at most a pass; what is taken up gives the
// same picture, bit for bit, as what was never stopped. Beside them, for people and other programs:
// <key>.exr, the picture, and <key>.json, what it is a picture of and how good it is.
#pragma once

#include <cstdint>
#include <filesystem>

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
  double relmse = 1e-3;  ///< estimated relative MSE (core/metrics) of the reference itself
  /// Computing time over all runs together, after which the reference stays as it is: processor time over the
  /// threads, so that a busy machine does not make it worse.
  double capSeconds = 100;
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

/// <cache folder>/references/<key>.sums
std::filesystem::path referenceFile(std::uint64_t key);

/// From the cache where it is good enough, else computed with `threads` threads (0 = on the calling one),
/// going on from what is there. Files that are torn or foreign are computed anew, and a cache folder that
/// cannot be written is done without; `warnings` says so. Throws core::Error when stopped, after keeping what
/// was done.
Reference computeReference(const app::Workspace& workspace, const ReferenceView& view,
                           const Confidence& confidence, int threads, const core::Progress& progress,
                           core::Warnings& warnings);

/// The same on all cores, with a progress bar and with warnings printed, one of them where the confidence was
/// not reached.
Reference referenceOf(const app::Workspace& workspace, const ReferenceView& view,
                      const Confidence& confidence, const std::stop_token& stop);

}  // namespace saccade::bench
