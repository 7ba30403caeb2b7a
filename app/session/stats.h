// Counts and times of a run, as --stats writes them.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/corrective/lattice.h"

namespace saccade::app {

struct RunStats {
  std::vector<double> frameMs;
  std::uint64_t missedDeadlines = 0;
  std::uint64_t samplesTraced = 0;   ///< corrective samples that reached a frame as exact ones
  std::uint64_t samplesReused = 0;   ///< cached samples warped into frames, summed over frames
  std::uint64_t samplesResumed = 0;  ///< pixels exact from the start by an earlier visit's samples
  std::uint64_t samplesDropped =
      0;  ///< removed by aging or the cache's bound, or traced beyond a sample budget
  std::array<std::uint64_t, core::Lattice::kMaxLevel + 1> levels{};  ///< traced samples by lattice level
  std::uint64_t nonDiffusePixels = 0;                                ///< of the last frame
  std::uint64_t fromDepth = 0;  ///< samples whose ray missed the named object (design fact 9)
  std::uint64_t rays = 0;
  double tracingSeconds = 0;              ///< wall time in which rays were traced
  std::map<std::string, double> stageMs;  ///< summed over frames
  bool converged = false;
  /// Window, from the program's start, 0 = never: until a scene's base layer was shown, and until the first
  /// frame of the walk in it was, which follows the camera and is corrected.
  double firstFrameMs = 0, firstWalkMs = 0;
  /// Window: the longest time for which it looked at no events while it opened scenes, 0 = it opened none.
  double longestWaitMs = 0;
  std::uint32_t seed = 1;
  int threads = 0;
  std::string context, renderer;
  std::vector<std::uint64_t> samplesPerFrame;

  /// p in [0, 1], nearest rank; 0 without frames.
  double framePercentileMs(double p) const;
};

/// Adds the time of its scope to one stage.
class StageTimer {
 public:
  StageTimer(RunStats& stats, const char* stage) : total_(stats.stageMs[stage]) {}
  ~StageTimer() {
    total_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Peak resident memory of this process in bytes; 0 where the system does not tell.
std::uint64_t peakBytes();

/// Throws core::Error when the file cannot be written.
void writeStats(const std::filesystem::path& file, const RunStats& stats);

}  // namespace saccade::app
