// `replay --verify`: whether replayed pictures are those that were recorded.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/recording/session_info.h"
#include "app/recording/session_settings.h"
#include "core/image.h"

namespace saccade::app {

/// Hashes bind to context, renderer, CPU and format. Where these are others than the recording's, pictures
/// whose hash differs still pass when no tile's mean differs by more than kTileTolerance of 255.
class SessionCheck {
 public:
  SessionCheck(const RecordedOn& recorded, const RecordedOn& here) : sameMachine_(recorded == here) {}

  /// Why the picture is not the recorded one, or nothing.
  std::optional<std::string> difference(const RecordedFrame& frame, const core::ImageRgba8& display);

  bool sameMachine() const { return sameMachine_; }
  std::int64_t equal() const { return equal_; }      ///< frames, bit for bit
  std::int64_t similar() const { return similar_; }  ///< frames that passed by their tiles alone
  int largestTileDifference() const { return largest_; }

 private:
  bool sameMachine_;
  std::int64_t equal_ = 0, similar_ = 0;
  int largest_ = 0;
};

}  // namespace saccade::app
