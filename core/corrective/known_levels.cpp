#include "core/corrective/known_levels.h"

#include <cassert>

#include "core/corrective/lattice.h"

namespace saccade::core {

// In integers, so that the picture is the same on every machine: four times the variance, squared, against
// the middle between two levels in the logarithm, 5^(k + 1/2).
int effectiveLevel(int level, std::int64_t cameraChanges) {
  assert(level >= 1 && level <= Lattice::kMaxLevel && cameraChanges >= 0);
  constexpr std::int64_t kLongAgo = 1000;  // coarser than any level, and its square fits
  const std::int64_t drift = cameraChanges < kLongAgo ? cameraChanges : kLongAgo;
  const std::int64_t variance = 4 * std::int64_t{Lattice::step(level)} + drift * drift;
  while (level > 1) {
    const std::int64_t step = Lattice::step(level);
    if (variance * variance <= 16 * 5 * step * step) break;
    --level;
  }
  return level;
}

}  // namespace saccade::core
