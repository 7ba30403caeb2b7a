// One walk of one method along a schedule, and what it gives. Main thread only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/harness/record.h"
#include "bench/moving/schedule.h"
#include "bench/reference/grade.h"

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

/// Errors of what was displayed at the key views, means over them; no map. `truths`: by key view.
Grade meanGrade(const WalkResult& walk, const std::vector<Grader>& truths);
/// Mean over key views of FLIP between the key view and the frame before it: true motion and flicker
/// together.
double stepOf(const WalkResult& walk);

/// Metrics by name.
using Metrics = std::map<std::string, double>;

/// frame_p50, frame_p95, frame_p99, missed_share, samples_per_second, rays_per_second, samples_per_frame,
/// reused_per_frame.
Metrics speedOf(const WalkResult& walk);

/// One of speedOf's over its repeats, with its unit and kind; a name that goes on ("missed_share_8ms") is of
/// the same kind.
Value speedValue(const std::string& name, const std::vector<double>& repeats);

}  // namespace saccade::bench
