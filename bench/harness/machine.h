// Where a figure comes from, and whether the machine was ours alone meanwhile. Linux.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/record.h"

namespace saccade::bench {

/// Above this share of all cores taken by other processes a measurement is marked as loaded.
inline constexpr double kLoadedShare = 0.05;

/// Everything but the load and what will be finished. `command` as the user typed it.
RunInfo describeRun(const std::string& command, std::uint32_t seed);

/// First line that a shell command prints, without its end; empty when it fails.
std::string firstLineOf(const std::string& command);

/// The share of the machine that others take from construction to asking: what the kernel counts as busy
/// (stolen time included) less this process and its children that have ended. Any thread.
class LoadWatch {
 public:
  LoadWatch();
  /// In [0, 1]; nothing where the kernel does not tell, or where too little time has passed to tell.
  std::optional<double> othersShare() const;

 private:
  struct Ticks {
    double busy = 0, total = 0, own = 0;  ///< seconds of all cores
  };
  static std::optional<Ticks> now();
  std::optional<Ticks> start_;
};

/// The most memory that was resident since construction: scene, maps and all else that stays included. Where
/// the kernel does not let the peak be forgotten, the process's. One at a time.
class PeakMemory {
 public:
  PeakMemory();
  std::uint64_t bytes() const;
};

/// Keeps the calling thread, and threads it starts meanwhile, on some cores; gives the old ones back at the
/// end. Numbers count the cores that the process may use, from 0.
class Pinned {
 public:
  explicit Pinned(const std::vector<int>& cores);
  ~Pinned();
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  std::vector<int> before_;
};

/// How the frame loop is spread: the main thread and the rasteriser share the first core, tracers and
/// analyzer have the others (all cores, where `workers` leaves no other choice). What uses every core itself
/// (path, raytrace) is left to the scheduler.
std::vector<int> mainCores();
std::vector<int> workerCores(int workers);

}  // namespace saccade::bench
