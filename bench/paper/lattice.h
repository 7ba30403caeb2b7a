// The square-root-of-five lattice of Haber et al. 2001, section 4.3, by two methods, and the splat sizes.
// Pure.
#pragma once

#include <cstdint>

#include "core/corrective/lattice.h"

namespace saccade::bench {

/// A checksum that keeps the work from vanishing and does not depend on the order.
struct LatticeTally {
  std::uint64_t points = 0, sum = 0;
  bool operator==(const LatticeTally&) const = default;
  void add(int x, int y) {
    ++points;
    sum += static_cast<std::uint64_t>(x) * 31 + static_cast<std::uint64_t>(y);
  }
};

/// Every pixel of a box once, level by level from 1 to 7, as the tracers walk it.
LatticeTally latticeIterative(const core::PixelBox& box);

/// The same by the paper's starting point: from each point of level l its four new neighbours of level l + 1,
/// p + R u, with u the spawning vector in floating point, clipped against the box.
LatticeTally latticeRecursive(const core::PixelBox& box);

/// Side of a splat by the paper's formula, |b| max(|cos|, |sin|) = max(|Re b|, |Im b|) of b = (2 - i)^(7 -
/// l).
int papersSplatSide(int level);

/// Pixels of a `size` x `size` image that no splat of levels 1..`last` touches, with centres all over the
/// plane. A splat of even side reaches one pixel farther to the left and the top.
int barePixels(int size, int last, int (*sideOf)(int level));

}  // namespace saccade::bench
