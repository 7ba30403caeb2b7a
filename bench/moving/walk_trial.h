// One walk of one method along a schedule, and what it gives. Main thread only.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/harness/record.h"
#include "bench/moving/schedule.h"

namespace saccade::bench {

/// What was seen at a key view.
struct Shot {
  core::ImageRgb linear;
  core::ImageRgba8 display, before;  ///< `before`: the frame before it
};

struct WalkResult {
  std::vector<Shot> shots;  ///< by key view
  app::RunStats stats;      ///< frameMs, samplesPerFrame, counts: of all frames but the first, which is cold
};

/// Draws every frame; nothing but copies of pictures happens between two of them.
WalkResult walkOnce(Walker& walker, const app::CameraPath& path, const Schedule& schedule);

/// Truth beside which the pictures of a walk are put. Errors are those of what is displayed (exposure 0) or
/// of linear radiance, as in core/metrics/comparison.h.
struct KeyTruth {
  core::ImageRgb reference;
  core::ImageGray salience;  ///< weights of flip_salient, of the reference
};

/// Metrics of a walk by name, see `valueOf`. Errors are means over key views.
using Metrics = std::map<std::string, double>;

/// flip, flip_median, flip_p95, flip_salient, relmse, rmse, psnr, ssim. `truths`: by key view.
Metrics errorsOf(const WalkResult& walk, const std::vector<KeyTruth>& truths);
/// flip_step: mean over key views of FLIP between the key view and the frame before it: true motion and
/// flicker together.
Metrics stepsOf(const WalkResult& walk);
/// frame_p50, frame_p95, frame_p99, missed_share, samples_per_second, rays_per_second, samples_per_frame,
/// reused_per_frame.
Metrics speedOf(const WalkResult& walk);

/// A metric over its repeats, with its unit and kind. `name` is one of the above.
Value valueOf(const std::string& name, const std::vector<double>& repeats);

}  // namespace saccade::bench
