// `replay --compare`: errors of one session's pictures against another's, frame by frame.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace saccade::app {

/// Of pictures as displayed: sRGB values in [0, 1] (core::compareDisplay).
class SessionComparison {
 public:
  struct Frame {
    std::int64_t number;
    double seconds;
    double rmse, flip;
  };

  /// Throws core::Error, naming the frame, where the sizes differ.
  void add(std::int64_t number, double seconds, const core::ImageRgba8& reference,
           const core::ImageRgba8& test);
  const std::vector<Frame>& frames() const { return frames_; }

  /// To stdout: a line a frame, then means and the worst frame by FLIP; or JSON {frames: [{frame, seconds,
  /// rmse, flip}], mean: {rmse, flip}, worst}.
  void print(bool json) const;

 private:
  std::vector<Frame> frames_;
};

}  // namespace saccade::app
