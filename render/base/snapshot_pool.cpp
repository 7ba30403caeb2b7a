#include "render/base/snapshot_pool.h"

namespace saccade::render {

namespace {
/// Main thread, analyzer and one job in flight hold frames; more than that is a burst not worth keeping.
constexpr std::size_t kMaxKept = 4;
}  // namespace

std::shared_ptr<core::FrameSnapshot> SnapshotPool::take() {
  std::unique_ptr<core::FrameSnapshot> frame;
  {
    const std::lock_guard lock(shelf_->mutex);
    if (!shelf_->free.empty()) {
      frame = std::move(shelf_->free.back());
      shelf_->free.pop_back();
    }
  }
  if (!frame) frame = std::make_unique<core::FrameSnapshot>();
  return {frame.release(), [shelf = shelf_](core::FrameSnapshot* used) {
            std::unique_ptr<core::FrameSnapshot> owned(used);
            const std::lock_guard lock(shelf->mutex);
            if (shelf->free.size() < kMaxKept) shelf->free.push_back(std::move(owned));
          }};
}

}  // namespace saccade::render
