#include "bench/paper/lattice.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace saccade::bench {
namespace {

using core::Lattice;
using core::PixelBox;

struct Vector {
  double x, y;
};

/// The points that are new in level `target` below one point of `level`: the point itself carries on, four
/// are spawned.
void recurse(const PixelBox& box, Vector p, Vector u, int level, int target, bool isNew,
             LatticeTally& tally) {
  // The subtree of a point reaches no further than the sum of the shrinking steps below it.
  const double reach = std::hypot(u.x, u.y);
  if (p.x < box.x0 - reach || p.x > box.x1 + reach || p.y < box.y0 - reach || p.y > box.y1 + reach) return;
  if (level == target) {
    const int x = static_cast<int>(std::lround(p.x)), y = static_cast<int>(std::lround(p.y));
    if (isNew && x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1) tally.add(x, y);
    return;
  }
  const Vector next{(2 * u.x - u.y) / 5, (u.x + 2 * u.y) / 5};  // u / (2 - i)
  recurse(box, p, next, level + 1, target, false, tally);
  const Vector steps[4] = {{next.x, next.y}, {-next.y, next.x}, {-next.x, -next.y}, {next.y, -next.x}};
  for (const Vector& s : steps) recurse(box, {p.x + s.x, p.y + s.y}, next, level + 1, target, true, tally);
}

}  // namespace

LatticeTally latticeIterative(const PixelBox& box) {
  LatticeTally tally;
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    core::walkLattice(box, core::beginLevel(box, level), box.area(), true,
                      [&](int x, int y) { tally.add(x, y); });
  }
  return tally;
}

LatticeTally latticeRecursive(const PixelBox& box) {
  LatticeTally tally;
  // (2 - i)^6: the spawning vector of level 1, so that level 7 has step 1.
  Vector u{1, 0};
  for (int i = 1; i < Lattice::kMaxLevel; ++i) u = {2 * u.x + u.y, 2 * u.y - u.x};
  const int span =
      static_cast<int>(std::ceil((box.x1 - box.x0 + box.y1 - box.y0) / std::hypot(u.x, u.y))) + 2;
  for (int target = 1; target <= Lattice::kMaxLevel; ++target) {
    for (int j = -span; j <= span; ++j) {
      for (int i = -span; i <= span; ++i) {
        recurse(box, {i * u.x - j * u.y, i * u.y + j * u.x}, u, 1, target, true, tally);
      }
    }
  }
  return tally;
}

int papersSplatSide(int level) {
  std::complex<double> b = 1;
  for (int i = level; i < Lattice::kMaxLevel; ++i) b *= std::complex<double>(2, -1);
  return static_cast<int>(std::lround(std::max(std::abs(b.real()), std::abs(b.imag()))));
}

int barePixels(int size, int last, int (*sideOf)(int level)) {
  std::vector<char> covered(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0);
  for (int level = 1; level <= last; ++level) {
    const int side = sideOf(level);
    const PixelBox box{-side, -side, size + side, size + side};
    core::walkLattice(box, core::beginLevel(box, level), box.area(), false, [&](int cx, int cy) {
      const int left = cx - side / 2, top = cy - side / 2;
      for (int y = std::max(0, top); y < std::min(size, top + side); ++y) {
        for (int x = std::max(0, left); x < std::min(size, left + side); ++x)
          covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                  static_cast<std::size_t>(x)] = 1;
      }
    });
  }
  return static_cast<int>(std::count(covered.begin(), covered.end(), 0));
}

}  // namespace saccade::bench
