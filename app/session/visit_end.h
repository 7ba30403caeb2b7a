// The frame that a visit of a scene ends with: while it is drawn again bit for bit, samples that were traced
// for it are exact.
#pragma once

#include <cstdint>

#include "app/cli/options.h"
#include "core/camera.h"
#include "core/corrective/messages.h"

namespace saccade::app {

struct PictureSettings;

struct VisitEnd {
  core::Camera camera;
  ImageSize size;
  std::uint64_t aging = 0;  ///< agingHash: other settings might have dropped samples that were shown
  std::uint64_t mask = 0;   ///< maskHash

  bool samePicture(const VisitEnd& o) const {
    return camera.samePicture(o.camera) && size.width == o.size.width && size.height == o.size.height;
  }
};

/// Of the settings that decide which samples stay in the cache.
std::uint64_t agingHash(const PictureSettings& settings);

/// Of ids and depths, bit by bit: what a correction takes from a frame beside its camera. Milliseconds.
std::uint64_t maskHash(const core::FrameSnapshot& frame);

/// The frame with only those pixels on its mask for which `left(x, y)` holds: what is still to be traced.
template <class Left>
core::FramePtr maskedFrame(const core::FrameSnapshot& frame, Left&& left) {
  auto rest = std::make_shared<core::FrameSnapshot>(frame);
  for (int y = 0; y < frame.view.height(); ++y) {
    for (int x = 0; x < frame.view.width(); ++x) {
      if (!left(x, y)) rest->ids[frame.index(x, y)] = 0;
    }
  }
  return rest;
}

}  // namespace saccade::app
