// One long stage of a bake: pieces of work in a fixed order whose results are plain arrays, so that it can
// pause after any piece, be kept in a file (checkpoint.h) and go on elsewhere with the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/progress.h"

namespace saccade::raytrace {

struct BakeStage {
  std::string name;         ///< as progress and checkpoints show it
  std::uint64_t units = 0;  ///< of work: particles, or blocks of texels
  std::uint64_t done = 0;   ///< [0, done) are finished
  /// Seconds relative to the other stages', until its own pace is known.
  double weight = 1;
  /// It does not read other stages' results: a little of it is done first, to learn its pace.
  bool independent = true;
  /// Works from unit `first` on until `last` or until progress.stop was requested, at least one piece.
  /// Returns the first unit that is not done. The results are the same for any ranges and threads.
  std::function<std::uint64_t(std::uint64_t first, std::uint64_t last, const core::Progress&)> work;
  std::span<std::byte> results;  ///< all that it found so far
  double seconds = 0;            ///< spent so far, sessions before this one included
};

}  // namespace saccade::raytrace
