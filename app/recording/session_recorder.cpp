#include "app/recording/session_recorder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <optional>
#include <utility>

#include "app/recording/session_format.h"
#include "core/error.h"

namespace saccade::app {

namespace {

/// The writer wakes by itself so often: being woken for each frame it would take the frame loop's core away
/// when all are busy.
constexpr std::chrono::milliseconds kPoll{100};
constexpr std::size_t kWakeBytes = std::size_t{16} << 20;  ///< wake it earlier for so much

double threadCpuSeconds() {
  std::timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

SessionRecorder::SessionRecorder(const std::filesystem::path& file, const SessionInfo& info) : file_(file) {
  refuseForeignFile(file);
  thread_ = std::thread([this, info] { work(info); });
}

SessionRecorder::~SessionRecorder() { finish(); }

SessionRecorder::Outcome SessionRecorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  arrived_.notify_one();
  if (thread_.joinable()) thread_.join();
  return outcome_;
}

void SessionRecorder::batch(core::SampleBatch&& batch) { push(std::move(batch)); }

void SessionRecorder::frame(const ShownFrame& shown) {
  PendingFrame pending;
  RecordedFrame& f = pending.frame;
  const core::View& view = shown.frame->view;
  f.seconds = seconds_;
  f.newView = shown.newView;
  f.camera = view.camera();
  f.size = {view.width(), view.height()};
  f.epoch = shown.frame->epoch;
  f.settings = {shown.settings, shown.attention};
  pending.display = shown.display;
  push(std::move(pending));
}

std::size_t SessionRecorder::bytesOf(const Item& item) {
  constexpr std::size_t kOverhead = 512;
  if (const auto* batch = std::get_if<core::SampleBatch>(&item))
    return kOverhead + batch->samples.size() * sizeof(core::Sample);
  return kOverhead + std::get<PendingFrame>(item).display->pixels().size() * sizeof(core::Rgba8);
}

void SessionRecorder::push(Item item) {
  const std::size_t bytes = bytesOf(item);
  bool wake = false;
  {
    std::unique_lock lock(mutex_);
    const bool room =
        written_.wait_for(lock, kPatience, [this] { return failed_ || waitingBytes_ < kQueueBytes; });
    if (failed_) return;
    if (!room) {
      failed_ = true;
      lock.unlock();
      spdlog::error("{}: recording stopped, the disk takes nothing any more; the walk goes on",
                    file_.string());
      return;
    }
    wake = waitingBytes_ / kWakeBytes != (waitingBytes_ + bytes) / kWakeBytes;
    waitingBytes_ += bytes;
    if (waiting_.items.empty()) waiting_.first = Clock::now();
    waiting_.items.push_back(std::move(item));
  }
  if (wake) arrived_.notify_one();
}

void SessionRecorder::work(const SessionInfo& info) {
  std::optional<SessionWriter> writer;
  try {
    writer.emplace(file_, info);
    writeAll(*writer);
    writer->finish();
    const std::lock_guard lock(mutex_);
    outcome_.complete = !failed_;
  } catch (const std::exception& e) {
    fail(e.what(), writer ? writer->frames() : 0);
  }
  const std::lock_guard lock(mutex_);
  outcome_.frames = writer ? writer->frames() : 0;
  outcome_.samples = writer ? writer->samples() : 0;
  outcome_.writerCpuSeconds = threadCpuSeconds();
}

void SessionRecorder::writeAll(SessionWriter& writer) {
  std::optional<Clock::time_point> atRiskSince;
  for (;;) {
    Arrivals arrivals = waitForItems();
    if (arrivals.items.empty()) {
      const std::lock_guard lock(mutex_);
      if (failed_ || (ending_ && waiting_.items.empty())) return;
    } else if (!atRiskSince) {
      atRiskSince = arrivals.first;
    }
    for (Item& item : arrivals.items) {
      const std::size_t bytes = bytesOf(item);
      write(writer, item);
      {
        const std::lock_guard lock(mutex_);
        waitingBytes_ -= bytes;
      }
      written_.notify_one();
    }
    if (atRiskSince && writer.commitIfDue()) {
      const std::chrono::duration<double> atRisk = Clock::now() - *std::exchange(atRiskSince, {});
      const std::lock_guard lock(mutex_);
      outcome_.longestAtRiskSeconds = std::max(outcome_.longestAtRiskSeconds, atRisk.count());
    }
  }
}

/// Nothing after kPoll, or when there is nothing more to come.
SessionRecorder::Arrivals SessionRecorder::waitForItems() {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, kPoll, [this] { return ending_ || waitingBytes_ >= kWakeBytes; });
  return std::exchange(waiting_, {});
}

void SessionRecorder::write(SessionWriter& writer, Item& item) {
  if (const auto* batch = std::get_if<core::SampleBatch>(&item)) return writer.write(*batch);
  auto& [frame, display] = std::get<PendingFrame>(item);
  frame.hash = frameHash(*display);
  frame.tiles = tileMeans(*display);
  display.reset();
  writer.write(frame);
}

void SessionRecorder::fail(const std::string& why, std::int64_t frames) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(failed_, true)) return;
    waiting_.items.clear();
  }
  written_.notify_all();
  if (frames > 0) {
    spdlog::error(
        "{}; recording stopped after {} frames, of which the last second's may be missing; the walk goes on",
        why, frames);
  } else {
    spdlog::error("{}; nothing is recorded, the walk goes on", why);
  }
}

}  // namespace saccade::app
