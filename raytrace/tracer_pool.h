// Tracer threads (Haber 2001, sections 4.2 and 4.4): each takes the best region's job, traces it and puts the
// samples into the sample queue.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/corrective/queues.h"
#include "raytrace/corrective_tracer.h"

namespace saccade::raytrace {

class TracerPool {
 public:
  /// Starts `threads` workers; 0 = none, use runOne(). `changeRates`: samples' are estimated, which only one
  /// of the aging tests reads. Queues and tracer must outlive the pool.
  TracerPool(const CorrectiveTracer& tracer, core::RegionQueue& regions, core::SampleQueue& samples,
             int threads, bool changeRates = false);
  /// Closes both queues and joins; a full sample queue does not hold it up.
  ~TracerPool();
  TracerPool(const TracerPool&) = delete;
  TracerPool& operator=(const TracerPool&) = delete;

  /// Inline mode: one job on the calling thread, its batch pushed. False when no job is left.
  bool runOne();
  /// Inline mode without the queue: traces the job and returns its batch.
  core::SampleBatch trace(const core::Job& job, std::uint8_t thread);

  /// Rethrows the first exception that ended a worker. Owner's thread.
  void check();
  /// Closes both queues and waits for the workers. Idempotent.
  void close();

  std::uint64_t samples() const { return samples_.load(std::memory_order_relaxed); }
  std::uint64_t rays() const { return rays_.load(std::memory_order_relaxed); }
  std::uint64_t nonFinite() const { return nonFinite_.load(std::memory_order_relaxed); }

 private:
  void work(std::uint8_t thread);

  const CorrectiveTracer& tracer_;
  core::RegionQueue& regions_;
  core::SampleQueue& sampleQueue_;
  const bool changeRates_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> samples_{0}, rays_{0}, nonFinite_{0};
  std::mutex failureMutex_;
  std::exception_ptr failure_;
  std::vector<std::jthread> workers_;
};

}  // namespace saccade::raytrace
