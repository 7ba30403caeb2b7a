// The ways of making pictures that the harness compares. A later capability adds its rows to allMethods().
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/session/frame_loop.h"
#include "app/session/headless.h"
#include "app/session/workspace.h"
#include "core/camera.h"
#include "core/image.h"

namespace saccade::bench {

/// A scene made ready: loaded, maps read or baked, world built, GL context made. Everything a method's
/// seconds do not count.
struct Stage {
  std::string name;  ///< of the scene, in keys and labels
  std::unique_ptr<app::Workspace> workspace;
  std::unique_ptr<app::Headless> gl;
  int tracers = 1;  ///< of the frame loop
  int cores = 1;    ///< threads of methods that have no frame loop
  std::uint32_t seed = 1;

  core::View view(const core::Camera& camera, app::ImageSize size) const;
};

/// Opens a scene; `quality` of its maps: preview, medium or high. Throws core::Error.
std::unique_ptr<Stage> openStage(const std::string& file, const std::string& quality, std::uint32_t seed,
                                 const std::stop_token& stop);

/// A frame loop whose main thread, rasteriser, tracers and analyzer are pinned as mainCores() and
/// workerCores() say, while the calling thread keeps `Pinned(mainCores())`.
std::unique_ptr<app::FrameLoop> pinnedLoop(const Stage& stage, app::FrameLoopOptions options);

/// One picture of a still view and what it took.
struct Point {
  std::string setting;  ///< what was turned to get here: "125 ms", "16 spp"; unique within the method
  double budgetMs = 0;  ///< the time it was given; 0 = it took what it took
  int subSamples = 0;   ///< a pixel, where that is what was turned; else 0
  double seconds = 0;   ///< wall time from nothing (scene, maps and GL ready) to this picture
  core::ImageRgb linear;
  std::uint64_t samples = 0, rays = 0;
};

/// What a still view is to be drawn with.
struct StillTask {
  core::Camera camera;
  app::ImageSize size;
  double longestSeconds = 0;  ///< a point that takes longer is the last
  std::stop_token stop;
};

/// A method on a moving camera. Main thread only.
class Walker {
 public:
  virtual ~Walker() = default;
  /// Draws the next frame in `budget` if it can; the frame's wall time is what stats() says.
  virtual void frame(const core::Camera& camera, std::chrono::duration<double> budget) = 0;
  virtual const core::ImageRgba8& display() const = 0;  ///< of the last frame
  virtual core::ImageRgb linear() = 0;
  virtual const app::RunStats& stats() const = 0;
};

struct Method {
  std::string name;     ///< --method: "base", "corrective", "raytrace", "path"
  std::string variant;  ///< unique within the name: "attention", "scanline-nocache"; may be empty
  std::map<std::string, std::string> labels;  ///< of its records: method, and order, cache, attention

  /// Pictures of a still view, cheapest first; calls `take` for each. Null: has no still view of its own.
  std::function<void(Stage&, const StillTask&, const std::function<void(Point)>& take)> still;
  /// Null: cannot walk.
  std::function<std::unique_ptr<Walker>(Stage&, app::ImageSize)> walk;
  /// The picture after its first so many samples, the same on any machine. Null: has no order of samples, or
  /// only that of another variant.
  std::function<Point(Stage&, const StillTask&, std::uint64_t samples)> afterSamples;

  /// "corrective-attention": what keys hold.
  std::string key() const { return variant.empty() ? name : name + "-" + variant; }
};

/// bench/methods/methods.cpp.
std::vector<Method> allMethods();

}  // namespace saccade::bench
