// Tells a click from a drag.
#pragma once

#include <optional>

#include "core/math/types.h"

namespace saccade::app {

/// Of one mouse button. One thread.
class ClickDetector {
 public:
  static constexpr float kDragPx = 4;  ///< a hand that clicks moves less

  void press() { travelledPx_ = 0; }
  void move(const core::Vec2& deltaPx) {
    if (travelledPx_) *travelledPx_ += glm::length(deltaPx);
  }
  /// Whether what began with press() was a click.
  bool release() {
    const bool click = travelledPx_ && *travelledPx_ < kDragPx;
    travelledPx_.reset();
    return click;
  }

 private:
  std::optional<float> travelledPx_;  ///< since press(); nothing: not pressed
};

}  // namespace saccade::app
