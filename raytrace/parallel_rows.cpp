#include "raytrace/parallel_rows.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/error.h"

namespace saccade::raytrace {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kReportEvery = std::chrono::milliseconds(50);

/// What the workers share.
struct Rows {
  Rows(int rowCount, const core::Progress& p, const std::function<void(int, int)>& f)
      : height(rowCount), progress(p), row(f) {}
  const int height;
  const core::Progress& progress;
  const std::function<void(int, int)>& row;
  std::atomic<int> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;  ///< failure, done, lastReport and the report itself
  std::exception_ptr failure;
  int done = 0;
  Clock::time_point lastReport = Clock::now();

  void work(int worker) {
    try {
      do {
        const int y = next.fetch_add(1);
        if (y >= height) return;
        row(y, worker);
        finished();
      } while (!failed && !progress.stop.stop_requested());
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      failed = true;
    }
  }
  void finished() {
    const std::lock_guard lock(mutex);
    ++done;
    const Clock::time_point now = Clock::now();
    if (!progress.report || (done < height && now - lastReport < kReportEvery)) return;
    lastReport = now;
    progress.report(static_cast<double>(done) / height);
  }
};

}  // namespace

int rowsUntilStopped(int height, int threads, const core::Progress& progress,
                     const std::function<void(int, int)>& row) {
  Rows rows(height, progress, row);
  {
    std::vector<std::jthread> workers;
    workers.reserve(static_cast<std::size_t>(std::max(0, threads)));
    for (int i = 0; i < threads; ++i) workers.emplace_back([&rows, i] { rows.work(i); });
    if (threads <= 0) rows.work(0);
  }
  if (rows.failure) std::rethrow_exception(rows.failure);
  return rows.done;  // handed out in order, and whatever was handed out was finished
}

void parallelRows(int height, int threads, const core::Progress& progress,
                  const std::function<void(int, int)>& row) {
  if (rowsUntilStopped(height, threads, progress, row) < height) throw core::Error("stopped on request");
}

}  // namespace saccade::raytrace
