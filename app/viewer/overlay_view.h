// The overlay that the window shows: computed when what it shows has changed, not with every frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/session/overlays.h"

namespace saccade::app {

/// What the panel explains.
struct ShownOverlay {
  AovScale scale;
  AovLegend legend;
};

/// Of one frame loop and its scene, which must outlive it. Main thread only.
class OverlayView {
 public:
  OverlayView(const FrameLoop& loop, const core::Scene& scene, int maxAge)
      : loop_(loop), scene_(scene), maxAge_(maxAge) {}

  /// Lays the overlay of the last step over its picture; strength in [0, 1].
  void draw(Aov aov, float strength, core::ImageRgba8& picture);
  /// Nothing is shown any more.
  void hide();
  /// What draw() drew last, unless hidden since.
  const std::optional<ShownOverlay>& shown() const { return shown_; }
  /// How often an overlay was computed.
  std::size_t computed() const { return computed_; }

 private:
  /// All that an overlay is a function of; what it does not depend on is left as it is here.
  struct Source {
    Aov aov;
    std::uint64_t epoch = 0;    ///< of the frame: ids, and what was warped into it
    std::uint64_t samples = 0;  ///< traced so far
    std::uint64_t cached = 0;   ///< SampleCache::stored: late samples of older cameras, too
    float delta = 0;
    std::shared_ptr<const attention::AttentionSnapshot> analysis;
    std::vector<std::uint32_t> ranks;
    bool operator==(const Source&) const = default;
  };
  Source sourceOf(Aov aov) const;

  const FrameLoop& loop_;
  const core::Scene& scene_;
  const int maxAge_;
  std::optional<Source> source_;  ///< of what colors_ and shown_ hold
  core::ImageRgba8 colors_;
  std::optional<ShownOverlay> shown_;
  std::size_t computed_ = 0;
};

}  // namespace saccade::app
