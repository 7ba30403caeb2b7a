#include "bench/reference/kept_sums.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <string>
#include <thread>

#include "app/cli/console.h"
#include "bench/harness/trials.h"
#include "core/cache_folder.h"
#include "core/maps.h"
#include "core/math/random.h"

namespace saccade::bench {
namespace {

constexpr double kSecondsBetweenCheckpoints = 10;

/// Of all threads of this process.
double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Sums while they grow.
class Computation {
 public:
  Computation(const SumsTask& task, const core::Progress& progress, core::Warnings& warnings)
      : task_(task), progress_(progress), warnings_(warnings), sums_(task.width, task.height) {
    takeUp();
  }

  KeptSums run() {
    const std::uint64_t before = sums_.samplesPerHalf;
    Clock::time_point saved = Clock::now();
    try {
      while (!done()) {
        addPass(before);
        if (secondsSince(saved) < kSecondsBetweenCheckpoints) continue;
        save();
        saved = Clock::now();
      }
    } catch (const core::Error&) {
      save();  // what was done before the stop
      throw;
    }
    const bool grew = sums_.samplesPerHalf > before;
    if (grew) save();
    return {std::move(sums_), reached(), grew, file_};
  }

 private:
  bool reached() const {
    return sums_.samplesPerHalf >= task_.leastSamplesPerHalf && error_ <= task_.wantedError;
  }
  bool done() const { return reached() || (sums_.samplesPerHalf > 0 && sums_.seconds >= task_.capSeconds); }

  void takeUp() {
    try {
      file_ = referenceFile(task_.key);
      if (!std::filesystem::exists(file_)) return;
      sums_ = readSums(file_, task_.key, task_.width, task_.height);
      error_ = task_.error(sums_);
    } catch (const core::Error& e) {
      warnings_.push_back(std::string(e.what()) + "; computing it anew");
    }
  }

  /// Both halves, or neither when it throws.
  void addPass(std::uint64_t before) {
    const double start = processorSeconds();
    std::array<core::ImageRgb, 2> means;
    for (int half = 0; half < 2; ++half) {
      const core::Progress inner{[&](double f) { report(before, (half + f) / 2); }, progress_.stop};
      means[static_cast<std::size_t>(half)] = task_.pass(half, sums_.samplesPerHalf, inner);
    }
    for (int half = 0; half < 2; ++half)
      sums_.add(half, means[static_cast<std::size_t>(half)], task_.samplesPerPass);
    sums_.samplesPerHalf += static_cast<std::uint64_t>(task_.samplesPerPass);
    sums_.seconds += (processorSeconds() - start) / std::max(1, task_.threads);
    error_ = task_.error(sums_);
  }

  /// `inPass`: the part of this pass that is done.
  void report(std::uint64_t before, double inPass) const {
    if (!progress_.report || !(sums_.seconds > 0)) return;
    const auto now = static_cast<double>(sums_.samplesPerHalf);
    const double byError = std::max(now * error_ / std::max(task_.wantedError, 1e-300),
                                    static_cast<double>(task_.leastSamplesPerHalf));
    const double byTime = now * task_.capSeconds / sums_.seconds;
    const double ahead = std::min(byError, byTime) - static_cast<double>(before);
    const double made = now + inPass * task_.samplesPerPass - static_cast<double>(before);
    progress_.report(ahead > 0 ? std::min(1.0, made / ahead) : 1);
  }

  /// A cache that cannot be written costs time the next time, nothing else.
  void save() {
    if (file_.empty() || sums_.samplesPerHalf == 0) return;
    try {
      std::error_code ignored;  // writing says what went wrong
      std::filesystem::create_directories(file_.parent_path(), ignored);
      writeSums(file_, task_.key, sums_);
    } catch (const core::Error& e) {
      warnings_.push_back(std::string(e.what()) + "; the reference is not kept (set XDG_CACHE_HOME)");
      file_.clear();
    }
  }

  const SumsTask& task_;
  const core::Progress& progress_;
  core::Warnings& warnings_;
  std::filesystem::path file_;  ///< empty: nothing is kept
  ReferenceSums sums_;
  double error_ = 0;  ///< of sums_
};

}  // namespace

std::uint32_t seedOfHalf(ReferenceKind kind, std::uint32_t seed, int half) {
  return core::hashKey(seed, static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(half), 0);
}

KeptSums keepSums(const SumsTask& task, const core::Progress& progress, core::Warnings& warnings) {
  return Computation(task, progress, warnings).run();
}

std::filesystem::path referenceFile(std::uint64_t key) {
  return core::cacheFolder() / "references" / (core::cacheName(key) + ".sums");
}

void computeReported(const std::stop_token& stop,
                     const std::function<void(int threads, const core::Progress& progress,
                                              core::Warnings& warnings)>& compute) {
  core::Warnings warnings;
  {
    app::ProgressBar bar("reference");
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    compute(threads, {[&](double fraction) { bar.show(fraction); }, stop}, warnings);
  }
  app::printWarnings(warnings);
}

}  // namespace saccade::bench
