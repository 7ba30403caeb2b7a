// Frames whose last holder lets go come back here with their buffers, whichever thread that is: 5 MB a frame
// at 512x512 are allocated a few times, not at every frame.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/corrective/messages.h"

namespace saccade::render {

/// Any thread. Frames may outlive the pool.
class SnapshotPool {
 public:
  /// A frame whose buffers hold whatever an earlier one left.
  std::shared_ptr<core::FrameSnapshot> take();

 private:
  struct Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<core::FrameSnapshot>> free;
  };
  std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace saccade::render
