#include "app/session/live_error.h"

#include <algorithm>
#include <cassert>
#include <exception>
#include <system_error>
#include <utility>

#include "app/session/idle_priority.h"
#include "core/composite.h"
#include "core/image_io.h"
#include "core/metrics/comparison.h"
#include "core/metrics/flip.h"
#include "raytrace/reference.h"

namespace saccade::app {

namespace {

std::size_t picturesWithin(std::size_t bytes, const core::FrameSnapshot& frame) {
  const std::size_t each = std::max<std::size_t>(1, frame.nonDiffusePixels * sizeof(core::Vec3));
  return std::clamp(bytes / each, LiveError::kMinPictures, LiveError::kMaxPictures);
}

/// Calls visit(i) for each non-diffuse pixel in scanline order.
template <class Visit>
void forEachNonDiffuse(const core::FrameSnapshot& frame, Visit&& visit) {
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    if (frame.ids[i] != 0) visit(i);
  }
}

std::vector<core::Vec3> ofNonDiffuse(const core::FrameSnapshot& frame,
                                     std::span<const core::Vec4> corrections) {
  std::vector<core::Vec3> kept;
  kept.reserve(frame.nonDiffusePixels);
  forEachNonDiffuse(frame, [&](std::size_t i) { kept.emplace_back(corrections[i]); });
  return kept;
}

/// The same additions as core::compositeLinear, on the pixels that differ from the reference at all.
core::ImageRgb pictureOf(const core::FrameSnapshot& frame, const core::ImageRgb& reference,
                         const std::vector<core::Vec3>& corrections) {
  core::ImageRgb picture = reference;
  auto next = corrections.begin();
  forEachNonDiffuse(frame,
                    [&](std::size_t i) { picture.pixels()[i] = core::Vec3(frame.baseAndId[i]) + *next++; });
  return picture;
}

}  // namespace

LiveError::LiveError(Trace trace) : trace_(std::move(trace)) {}

LiveError::~LiveError() { cancel_.request_stop(); }

void LiveError::observe(const RestingPicture& picture) {
  assert(picture.frame && picture.seconds > 0);
  if (picture.frame != frame_) {
    reset();
    begin(picture.frame);
  }
  if (picture.exposureEv != exposureEv_) setExposure(picture.exposureEv);
  const bool wanted = picture.converged || pictures_.wants(picture.seconds);
  if (!complete_ && wanted) keep(picture);
  if (!released_ && picture.seconds >= kRestSeconds) release();
}

void LiveError::begin(const core::FramePtr& frame) {
  const std::lock_guard lock(mutex_);
  cancel_ = std::stop_source();
  frame_ = frame;
  pictures_ = Series(picturesWithin(kPictureBytes, *frame));
}

void LiveError::setExposure(float ev) {
  {
    const std::lock_guard lock(mutex_);
    exposureEv_ = ev;
    for (const Series::Entry& entry : pictures_.entries()) entry.item->error.reset();
  }
  changed_.notify_one();
}

void LiveError::keep(const RestingPicture& picture) {
  auto kept =
      std::make_shared<Picture>(Picture{picture.seconds, ofNonDiffuse(*frame_, picture.corrections), {}});
  {
    const std::lock_guard lock(mutex_);
    pictures_.add(picture.seconds, std::move(kept));
    complete_ = picture.converged;
  }
  changed_.notify_one();
}

void LiveError::release() {
  {
    const std::lock_guard lock(mutex_);
    released_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) return;
  try {
    thread_ = std::jthread([this](const std::stop_token& end) { work(end); });
  } catch (const std::system_error& e) {
    const std::lock_guard lock(mutex_);
    failure_ = e.what();
  }
}

void LiveError::reset() {
  if (!frame_) return;
  cancel_.request_stop();
  Series pictures(kMinPictures);  // these go after the lock is free
  std::shared_ptr<const core::ImageRgb> reference;
  const std::lock_guard lock(mutex_);
  frame_.reset();
  std::swap(pictures_, pictures);
  std::swap(reference_, reference);
  referenceDone_ = 0;
  released_ = complete_ = false;
  failure_.clear();
}

LiveError::State LiveError::state() const {
  const std::lock_guard lock(mutex_);
  State state{frame_ != nullptr, referenceDone_, {}, 0, false, failure_};
  for (const Series::Entry& entry : pictures_.entries()) {
    if (entry.item->error) {
      state.points.push_back(*entry.item->error);
    } else {
      ++state.waiting;
    }
  }
  state.complete = complete_ && state.waiting == 0;
  return state;
}

void LiveError::work(const std::stop_token& end) {
  runAtIdlePriority();
  while (const std::optional<Task> task = nextTask(end)) run(*task);
}

std::optional<LiveError::Task> LiveError::nextTask(const std::stop_token& end) {
  std::unique_lock lock(mutex_);
  std::optional<Task> task;
  changed_.wait(lock, end, [&] { return (task = findTask()).has_value(); });
  return end.stop_requested() ? std::nullopt : task;
}

std::optional<LiveError::Task> LiveError::findTask() const {
  if (!frame_ || !released_ || !failure_.empty()) return {};
  Task task{frame_, reference_, nullptr, exposureEv_, cancel_.get_token()};
  if (!reference_) return task;
  for (const Series::Entry& entry : pictures_.entries()) {
    task.picture = entry.item;
    if (!entry.item->error) return task;
  }
  return {};
}

// What goes wrong here must not end the walk: the panel says it in place of the curve.
void LiveError::run(const Task& task) {
  try {
    if (task.reference) {
      measure(task);
    } else {
      traceReference(task);
    }
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    if (!task.stop.stop_requested()) failure_ = e.what();
  }
}

void LiveError::traceReference(const Task& task) {
  const auto report = [&](double fraction) {
    const std::lock_guard lock(mutex_);
    if (!task.stop.stop_requested()) referenceDone_ = std::min(fraction, 0.99);  // 1 = it can be used
  };
  const core::FrameSnapshot& frame = *task.frame;
  const std::vector<core::Vec4> corrections = trace_(frame, {report, task.stop});
  auto reference = std::make_shared<const core::ImageRgb>(
      core::compositeLinear(frame.view.width(), frame.view.height(), frame.baseAndId, corrections));
  const std::lock_guard lock(mutex_);
  if (task.stop.stop_requested()) return;
  reference_ = std::move(reference);
  referenceDone_ = 1;
}

void LiveError::measure(const Task& task) {
  const core::ImageRgb& reference = *task.reference;
  const core::ImageRgb picture = pictureOf(*task.frame, reference, task.picture->corrections);
  ErrorPoint error{task.picture->seconds, core::relativeMse(reference, picture), 0};
  error.flip = core::meanOf(core::flip(core::toDisplay(reference, task.exposureEv),
                                       core::toDisplay(picture, task.exposureEv), core::kFlipPixelsPerDegree,
                                       task.stop));
  const std::lock_guard lock(mutex_);
  if (!task.stop.stop_requested() && task.exposureEv == exposureEv_) task.picture->error = error;
}

LiveError::Trace tracedBy(const raytrace::CorrectiveTracer& tracer) {
  return [tracer](const core::FrameSnapshot& frame, const core::Progress& progress) {
    return raytrace::traceAll(tracer, frame, 0, progress).corrections;
  };
}

}  // namespace saccade::app
