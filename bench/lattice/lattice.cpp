// Iterative against recursive generation of the square-root-of-five lattice (Haber 2001, section 4.3: "about
// eight times faster"). Both visit every pixel of a box once, level by level from 1 to 7; a checksum keeps
// the work from vanishing. The recursive method is the paper's starting point: from each point of level l its
// four new neighbours of level l + 1, p + R u, with u the spawning vector in floating point, clipped against
// the box. Usage: bench_lattice [SIDE] [REPEATS]
#include "core/corrective/lattice.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "bench/common.h"

namespace saccade::bench {
namespace {

using core::Lattice;
using core::PixelBox;

struct Tally {
  std::uint64_t points = 0, sum = 0;
  void add(int x, int y) {
    ++points;
    sum += static_cast<std::uint64_t>(x) * 31 + static_cast<std::uint64_t>(y);
  }
};

Tally iterative(const PixelBox& box) {
  Tally tally;
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    core::walkLattice(box, core::beginLevel(box, level), box.area(), true,
                      [&](int x, int y) { tally.add(x, y); });
  }
  return tally;
}

struct Vector {
  double x, y;
};

/// The points that are new in level `target` below one point of `level`: the point itself carries on, four
/// are spawned.
void recurse(const PixelBox& box, Vector p, Vector u, int level, int target, bool isNew, Tally& tally) {
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

Tally recursive(const PixelBox& box) {
  Tally tally;
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

int run(int argc, char** argv) {
  printProvenance(argc, argv);
  const int side = argc > 1 ? std::atoi(argv[1]) : 512;
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 7;
  const PixelBox box{0, 0, side, side};
  const Tally a = iterative(box), b = recursive(box);
  if (a.points != b.points || a.sum != b.sum || a.points != static_cast<std::uint64_t>(box.area())) {
    std::printf("the two methods disagree: %llu and %llu points of %lld\n",
                static_cast<unsigned long long>(a.points), static_cast<unsigned long long>(b.points),
                static_cast<long long>(box.area()));
    return 1;
  }
  std::vector<double> fast, slow, ratio;
  for (int i = 0; i < repeats; ++i) {
    std::uint64_t kept = 0;
    fast.push_back(timed([&] { kept += iterative(box).sum; }));
    slow.push_back(timed([&] { kept += recursive(box).sum; }));
    if (kept != 2 * a.sum) return 1;
    ratio.push_back(slow.back() / fast.back());
  }
  const double n = static_cast<double>(a.points);
  const Spread r = spread(ratio);
  std::printf(
      "%dx%d, all levels: iterative %.2f ns a point, recursive %.2f ns, ratio %.1f (%.1f to %.1f); the "
      "paper: about 8\n",
      side, side, 1e9 * spread(fast).median / n, 1e9 * spread(slow).median / n, r.median, r.min, r.max);
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
