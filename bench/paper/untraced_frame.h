// The frame without tracing: age, draw, read back, warp, splat and composite with a cache as a walk leaves it
// (Haber 2001, section 5: everything but the correction step), stage by stage, beside the bare draw.
#pragma once

#include <cstddef>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "render/splat/correction_layer.h"
#include "render/splat/sample_cache.h"

namespace saccade::bench {

/// Wall milliseconds of one frame.
struct UntracedFrame {
  double age = 0;
  double draw = 0;     ///< OpenGL until it has finished
  double read = 0;     ///< colour, ID and depth into main memory
  double measure = 0;  ///< boxes and start levels of the objects
  double warp = 0;     ///< the layer's beginFrame, warping and splatting
  double composite = 0;
  double total = 0;
  double splatted = 0;  ///< samples that the warp handed to the layer
};

/// A sample cache's contents, to be filled in anew before every frame: frames age, drop and hide samples.
class FrozenCache {
 public:
  /// The youngest `samples` of the cache, or all.
  FrozenCache(const render::SampleCache& cache, std::size_t samples);

  /// Brings an empty cache to the frozen one's camera age and samples. `view` is any view of the walk's focal
  /// length.
  void thaw(const core::View& view, render::SampleCache& cache) const;
  std::size_t size() const { return size_; }

 private:
  struct Age {
    std::uint64_t age;
    core::SampleBatch batch;
  };
  std::vector<Age> ages_;  ///< oldest first
  std::uint64_t cameraAge_;
  std::size_t size_ = 0;
};

/// Frames of the gallery's size and path, 1/25 s apart, at six places of it. GL thread.
class UntracedWalk {
 public:
  static constexpr std::size_t kSamples = 50'000;

  /// Walks to the places, which takes seconds.
  UntracedWalk(const Stage& stage, const app::CameraPath& path);

  /// Every stage's median over all places' frames.
  UntracedFrame medians();
  /// Median of the same frames' bare draw, milliseconds until GL has finished.
  double bareDraw();
  /// Of all places together.
  std::size_t cachedSamples() const;
  int places() const { return static_cast<int>(places_.size()); }

 private:
  struct Place {
    FrozenCache cache;
    std::vector<core::View> views;
  };
  UntracedFrame step(const core::View& view, render::SampleCache& cache);

  const Stage& stage_;
  std::vector<Place> places_;
  render::CorrectionLayer layer_;
  core::ImageRgba8 display_;
};

}  // namespace saccade::bench
