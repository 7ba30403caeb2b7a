#include "raytrace/tracer_pool.h"

#include <array>
#include <span>
#include <utility>

#include "core/corrective/change_rate.h"

namespace saccade::raytrace {
namespace {

/// Pixels between two looks at the stop flag.
constexpr std::size_t kPollPixels = 16;

}  // namespace

TracerPool::TracerPool(const CorrectiveTracer& tracer, core::RegionQueue& regions, core::SampleQueue& samples,
                       int threads, bool changeRates)
    : tracer_(tracer), regions_(regions), sampleQueue_(samples), changeRates_(changeRates) {
  workers_.reserve(threads > 0 ? threads : 0);
  try {
    for (int i = 0; i < threads; ++i) {
      workers_.emplace_back([this, i] { work(static_cast<std::uint8_t>(i)); });
    }
  } catch (...) {
    close();
    throw;
  }
}

TracerPool::~TracerPool() { close(); }

void TracerPool::close() {
  stopping_ = true;
  regions_.close();
  sampleQueue_.close();
  workers_.clear();
}

void TracerPool::check() {
  const std::lock_guard lock(failureMutex_);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

core::SampleBatch TracerPool::trace(const core::Job& job, std::uint8_t thread) {
  core::SampleBatch batch;
  batch.epoch = job.frame->epoch;
  batch.sequence = job.sequence;
  RayCounters counters;
  std::array<core::Pixel, kPollPixels> pixels;
  std::size_t waiting = 0;
  const auto traceWaiting = [&] {
    if (!stopping_.load(std::memory_order_relaxed)) {
      tracer_.trace(*job.frame, std::span(pixels).first(waiting), job.begin.level, counters, batch.samples);
    }
    waiting = 0;
  };
  core::forEachPixel(job, [&](int x, int y) {
    pixels[waiting++] = {x, y};
    if (waiting == pixels.size()) traceWaiting();
  });
  traceWaiting();
  if (changeRates_) core::estimateChangeRates(batch.samples);
  for (core::Sample& s : batch.samples) s.thread = thread;
  samples_.fetch_add(batch.samples.size(), std::memory_order_relaxed);
  rays_.fetch_add(counters.rays, std::memory_order_relaxed);
  nonFinite_.fetch_add(counters.nonFinite, std::memory_order_relaxed);
  return batch;
}

bool TracerPool::runOne() {
  const std::optional<core::Job> job = regions_.tryPop();
  if (!job) return false;
  sampleQueue_.push(trace(*job, 0));
  return true;
}

void TracerPool::work(std::uint8_t thread) {
  try {
    while (std::optional<core::Job> job = regions_.pop()) {
      if (!sampleQueue_.push(trace(*job, thread))) return;
    }
  } catch (...) {
    const std::lock_guard lock(failureMutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

}  // namespace saccade::raytrace
