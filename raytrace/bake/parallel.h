// Runs independent pieces of a bake on several threads, or inline, with progress and cancellation.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/progress.h"

namespace saccade::raytrace {

/// The share [from, to] of a bake's progress that one stage makes up.
struct ProgressShare {
  double from = 0, to = 1;
};

/// Calls work(i) once for every i in [0, count), from `threads` threads (0 = the calling one); the order is
/// not defined, so results must not depend on it. Rethrows the first exception of a piece; throws core::Error
/// when progress.stop was requested before all pieces were done.
template <class Work>
void parallelFor(int threads, std::size_t count, const core::Progress& progress, ProgressShare share,
                 Work&& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;  // guards the three below
  std::exception_ptr failure;
  std::size_t done = 0;
  auto lastReport = std::chrono::steady_clock::now() - std::chrono::seconds(1);
  const auto finishPiece = [&] {
    const std::lock_guard lock(mutex);
    ++done;
    const auto now = std::chrono::steady_clock::now();
    if (!progress.report || (done < count && now - lastReport < std::chrono::milliseconds(50))) return;
    lastReport = now;
    progress.report(share.from +
                    (share.to - share.from) * static_cast<double>(done) / static_cast<double>(count));
  };
  const auto run = [&] {
    while (!failed && !progress.stop.stop_requested()) {
      const std::size_t i = next.fetch_add(1);
      if (i >= count) return;
      try {
        work(i);
        finishPiece();
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        failed = true;
      }
    }
  };
  if (threads <= 0) {
    run();
  } else {
    std::vector<std::jthread> pool;
    pool.reserve(static_cast<std::size_t>(threads));
    for (int t = 0; t < threads; ++t) pool.emplace_back(run);
  }
  if (failure) std::rethrow_exception(failure);
  if (done < count) throw core::Error("illumination maps: stopped before they were done");
}

}  // namespace saccade::raytrace
