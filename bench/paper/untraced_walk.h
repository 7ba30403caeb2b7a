// Frames without tracing, with a cache as a walk leaves it, beside the bare draw.
#pragma once

#include <cstddef>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/harness/untraced_frame.h"
#include "render/splat/sample_cache.h"

namespace saccade::bench {

/// A sample cache's contents, to be filled in anew before every frame: frames age, drop and hide samples.
class FrozenCache {
 public:
  /// The youngest `samples` of the cache, or all.
  FrozenCache(const render::SampleCache& cache, std::size_t samples);

  /// Brings an empty cache to the frozen one's camera age and samples. `view` is any view of the walk's focal
  /// length.
  void thaw(const core::View& view, render::SampleCache& cache) const;
  /// The youngest of them.
  FrozenCache youngest(std::size_t samples) const;
  std::size_t size() const { return size_; }

 private:
  void dropOldest(std::size_t excess);

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

  const Stage& stage_;
  std::vector<Place> places_;
  UntracedPicture picture_;
};

}  // namespace saccade::bench
