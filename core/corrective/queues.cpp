#include "core/corrective/queues.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace saccade::core {

void SnapshotMailbox::put(AnalysisInput input) {
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    // The frame that nobody took dies outside the lock, with the argument.
    if (newest_) {
      std::swap(*newest_, input);
    } else {
      newest_ = std::move(input);
    }
  }
  arrived_.notify_one();
}

std::optional<AnalysisInput> SnapshotMailbox::take() {
  std::unique_lock lock(mutex_);
  waiting_ = true;
  arrived_.wait(lock, [this] { return newest_ || closed_; });
  waiting_ = false;
  if (closed_) return std::nullopt;
  return std::exchange(newest_, std::nullopt);
}

bool SnapshotMailbox::wanted() const {
  const std::lock_guard lock(mutex_);
  return waiting_ && !newest_ && !closed_;
}

void SnapshotMailbox::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    newest_.reset();
  }
  arrived_.notify_all();
}

bool RegionQueue::later(const Region& a, const Region& b) {
  return a.priority != b.priority ? a.priority < b.priority : a.id > b.id;
}

/// One multiplication per level done, so that setPriorities with the values it already has changes no bit.
float RegionQueue::reducedPriority(const Region& region) const {
  const float base = basePriority_[region.id];
  float priority = std::min(base, 1.0f) * gains_[region.id];
  for (int l = 1; l < region.cursor.level + (region.refresh ? 1 : 0); ++l) priority *= kept_;
  return priority + std::max(base - 1, 0.0f);
}

void RegionQueue::beginFrame(FramePtr frame, std::vector<float> gains, KnownLevels known) {
  assert(!known || known->size() == frame->ids.size());
  gains.resize(frame->extents.size(), 1);
  {
    const std::lock_guard lock(mutex_);
    if (!frame_ || frame_->epoch != frame->epoch) nextSequence_ = 0;
    // The old frame, if it was the last reference, dies outside the lock, with the argument.
    std::swap(frame_, frame);
    std::swap(known_, known);
    const auto& extents = frame_->extents;
    if (basePriority_.size() < extents.size()) basePriority_.resize(extents.size(), kUnseenPriority);
    std::swap(gains_, gains);
    heap_.clear();
    for (std::uint32_t id = 1; id < extents.size(); ++id) {
      const ObjectExtent& e = extents[id];
      if (e.pixels == 0) continue;
      const double boxPerMask = static_cast<double>(e.box.area()) / e.pixels;
      const auto points = static_cast<std::int64_t>(std::llround(jobSize_ * boxPerMask));
      heap_.push_back({id, 0, beginLevel(e.box, e.startLevel), false, points});
      heap_.back().priority = reducedPriority(heap_.back());
    }
    std::make_heap(heap_.begin(), heap_.end(), later);
  }
  filled_.notify_all();
}

void RegionQueue::setPriorities(std::span<const float> byId) {
  const std::lock_guard lock(mutex_);
  if (basePriority_.size() < byId.size()) basePriority_.resize(byId.size(), kUnseenPriority);
  for (std::size_t id = 1; id < byId.size(); ++id) {
    // 0 = the analysis did not see the object: should it come into view, it starts ahead of what is partly
    // corrected.
    const float given =
        byId[id] > 0 ? std::clamp(byId[id], kLowestPriority, kHighestPriority) : kLowestPriority;
    basePriority_[id] = byId[id] == 0 ? kUnseenPriority : given;
  }
  for (Region& region : heap_) region.priority = reducedPriority(region);
  std::make_heap(heap_.begin(), heap_.end(), later);
}

std::optional<Job> RegionQueue::popLocked() {
  if (closed_ || heap_.empty()) return std::nullopt;
  std::pop_heap(heap_.begin(), heap_.end(), later);
  Region& region = heap_.back();
  const ObjectExtent& extent = frame_->extents[region.id];
  Job job{
      frame_,          region.id,       region.cursor, region.points, region.cursor.level > extent.startLevel,
      nextSequence_++, region.priority, known_,        region.refresh};
  region.cursor = skipLattice(extent.box, region.cursor, region.points);
  if (region.cursor.y >= extent.box.y1 && !beginNextLevel(region)) {
    heap_.pop_back();
  } else {
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
  return job;
}

/// False when the region is done.
bool RegionQueue::beginNextLevel(Region& region) const {
  const bool last = region.cursor.level == Lattice::kMaxLevel;
  if (last && (!known_ || region.refresh)) return false;
  region.refresh = last;
  region.cursor = beginLevel(frame_->extents[region.id].box, region.cursor.level + (last ? 0 : 1));
  region.priority = reducedPriority(region);
  return true;
}

std::optional<Job> RegionQueue::tryPop() {
  const std::lock_guard lock(mutex_);
  return popLocked();
}

std::optional<Job> RegionQueue::pop() {
  std::unique_lock lock(mutex_);
  filled_.wait(lock, [this] { return !heap_.empty() || closed_; });
  return popLocked();
}

void RegionQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  filled_.notify_all();
}

std::vector<std::uint32_t> RegionQueue::ranks() const {
  std::vector<Region> regions;
  std::vector<std::uint32_t> ranks;
  {
    const std::lock_guard lock(mutex_);
    regions = heap_;
    ranks.resize(frame_ ? frame_->extents.size() : 0);
  }
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return later(b, a); });
  std::uint32_t rank = 0;
  for (const Region& region : regions) ranks[region.id] = ++rank;
  return ranks;
}

bool RegionQueue::exhausted() const {
  const std::lock_guard lock(mutex_);
  return heap_.empty();
}

bool SampleQueue::push(SampleBatch batch) {
  {
    std::unique_lock lock(mutex_);
    notFull_.wait(lock, [this] { return batches_.size() < maxBatches_ || closed_; });
    if (closed_) return false;
    batches_.push_back(std::move(batch));
  }
  notEmpty_.notify_one();
  return true;
}

std::optional<SampleBatch> SampleQueue::takeFront(std::unique_lock<std::mutex> lock) {
  if (batches_.empty()) return std::nullopt;
  std::optional<SampleBatch> batch = std::move(batches_.front());
  batches_.pop_front();
  lock.unlock();
  notFull_.notify_one();
  return batch;
}

std::optional<SampleBatch> SampleQueue::tryPop() { return takeFront(std::unique_lock(mutex_)); }

std::optional<SampleBatch> SampleQueue::popUntil(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  notEmpty_.wait_until(lock, deadline, [this] { return !batches_.empty() || closed_; });
  return takeFront(std::move(lock));
}

void SampleQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  notEmpty_.notify_all();
  notFull_.notify_all();
}

}  // namespace saccade::core
