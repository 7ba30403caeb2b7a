// How every reference is made: passes of samples are added to its sums (sums.h) until its error is low
// enough, or until the time for it is used up. The sums lie in <cache folder>/references/<key>.sums, are
// written every few seconds and when a stop is requested, and are taken up again by the next run, so a
// stopped run loses at most a pass; what is taken up gives the same numbers, bit for bit, as what was never
// stopped. Files that are torn or foreign are computed anew.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>

#include "bench/reference/sums.h"
#include "core/error.h"
#include "core/progress.h"

namespace saccade::bench {

/// What the samples of a pass are of. The values are part of their seeds.
enum class ReferenceKind : std::uint32_t { picture = 0x5EFE'0000u, points = 0x5EFE'0001u };

/// Seeds that no method under test uses, far apart for kinds and halves.
std::uint32_t seedOfHalf(ReferenceKind kind, std::uint32_t seed, int half);

struct SumsTask {
  std::uint64_t key = 0;  ///< a hash of all that the sums depend on
  int width = 0, height = 0;
  int samplesPerPass = 1;                 ///< a pixel, of each half
  std::uint64_t leastSamplesPerHalf = 0;  ///< below it, rare bright paths may be in no estimate
  /// Mean of samplesPerPass samples after the first `done` of a half. Throws core::Error when stopped.
  std::function<core::ImageRgb(int half, std::uint64_t done, const core::Progress& progress)> pass;
  /// Of sums of at least one pass: an estimate that falls as one over the samples (a variance, no deviation).
  std::function<double(const ReferenceSums& sums)> error;

  double wantedError = 0;
  /// Computing time over all runs together, after which the sums stay as they are: processor time over the
  /// threads, so that a busy machine does not make them worse.
  double capSeconds = 0;
  int threads = 1;  ///< that pass() uses; 0 counts as 1
};

struct KeptSums {
  ReferenceSums sums;
  bool reached = false;        ///< the error that was wanted
  bool grew = false;           ///< by a pass of this run at least
  std::filesystem::path file;  ///< empty: the cache folder cannot be written, and `warnings` says so
};

/// From the cache where it is good enough, else computed, going on from what is there. `warnings` says what
/// was wrong with a file. Throws core::Error when stopped, after keeping what was done.
KeptSums keepSums(const SumsTask& task, const core::Progress& progress, core::Warnings& warnings);

/// <cache folder>/references/<key>.sums
std::filesystem::path referenceFile(std::uint64_t key);

/// Calls `compute` for all cores with a progress bar, then prints the warnings.
void computeReported(const std::stop_token& stop,
                     const std::function<void(int threads, const core::Progress& progress,
                                              core::Warnings& warnings)>& compute);

}  // namespace saccade::bench
