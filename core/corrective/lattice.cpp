#include "core/corrective/lattice.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace saccade::core {
namespace {

constexpr int kLevels = Lattice::kMaxLevel;

struct Level {
  std::int64_t step = 1;  ///< 5^k
  std::int64_t root = 0;  ///< r_k: r_k^2 = -1 (mod 5^k), r_k = 3 (mod 5), from x + 2y = 0 for 2 - i
  int side = 1;           ///< |Re| + |Im| of (2 - i)^k
};

/// Indexed by k = kMaxLevel - level.
constexpr std::array<Level, kLevels> makeLevels() {
  std::array<Level, kLevels> levels{};
  std::int64_t re = 1, im = 0;
  for (int k = 1; k < kLevels; ++k) {
    const std::int64_t nextRe = 2 * re + im;
    im = 2 * im - re;
    re = nextRe;
    levels[k].side = static_cast<int>((re < 0 ? -re : re) + (im < 0 ? -im : im));
    levels[k].step = 5 * levels[k - 1].step;
    // Hensel: exactly one of the five lifts of r_(k-1) is a root modulo 5^k.
    std::int64_t root = k == 1 ? 3 : levels[k - 1].root;
    while ((root * root + 1) % levels[k].step != 0) root += levels[k - 1].step;
    levels[k].root = root;
  }
  return levels;
}
constexpr std::array<Level, kLevels> kTable = makeLevels();
static_assert(kTable[6].step == 15625 && kTable[6].side == 161 && kTable[1].root == 3);

const Level& at(int level) {
  assert(level >= 1 && level <= kLevels);
  return kTable[kLevels - level];
}

/// (x - r_k y) mod 5^k up to sign: zero iff the pixel is in the lattice. Reducing y first keeps the product
/// small for any integers. The divisor is a constant so that no division instruction is needed.
template <int k>
bool divides(std::int64_t x, std::int64_t y) {
  constexpr std::int64_t m = kTable[k].step;
  return (x % m - kTable[k].root * (y % m)) % m == 0;
}

}  // namespace

int Lattice::step(int level) { return static_cast<int>(at(level).step); }
int Lattice::splatSide(int level) { return at(level).side; }

bool Lattice::contains(int level, std::int64_t x, std::int64_t y) {
  assert(level >= 1 && level <= kMaxLevel);
  switch (kMaxLevel - level) {
    case 0:
      return true;
    case 1:
      return divides<1>(x, y);
    case 2:
      return divides<2>(x, y);
    case 3:
      return divides<3>(x, y);
    case 4:
      return divides<4>(x, y);
    case 5:
      return divides<5>(x, y);
    default:
      return divides<6>(x, y);
  }
}

int Lattice::levelOf(std::int64_t x, std::int64_t y) {
  int level = kMaxLevel;
  while (level > 1 && contains(level - 1, x, y)) --level;
  return level;
}

std::int64_t Lattice::firstInRow(int level, std::int64_t x0, std::int64_t y) {
  const Level& l = at(level);
  // Distance from x0 up to the next x = r y (mod step), brought into [0, step).
  const std::int64_t distance = (l.root * (y % l.step) - x0 % l.step) % l.step;
  return x0 + (distance < 0 ? distance + l.step : distance);
}

LatticeCursor beginLevel(const PixelBox& box, int level) {
  return {level, box.y0, Lattice::firstInRow(level, box.x0, box.y0)};
}

LatticeCursor skipLattice(const PixelBox& box, LatticeCursor cursor, std::int64_t points) {
  const std::int64_t step = Lattice::step(cursor.level);
  while (cursor.y < box.y1) {
    const std::int64_t left = cursor.x < box.x1 ? (box.x1 - cursor.x + step - 1) / step : 0;
    if (points < left) {
      cursor.x += points * step;
      return cursor;
    }
    points -= left;
    ++cursor.y;
    cursor.x = Lattice::firstInRow(cursor.level, box.x0, cursor.y);
  }
  return cursor;
}

}  // namespace saccade::core
