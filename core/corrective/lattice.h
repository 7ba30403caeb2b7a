// The square-root-of-five lattice of Haber 2001, section 4.3, in integer arithmetic.
//
// Level l of kMaxLevel is the ideal (2 - i)^k Z[i], k = kMaxLevel - l, anchored at pixel (0, 0); pixel (x, y)
// is x + iy. Departure from the paper: no rotation matrices and no clipping. (2 - i)^k is primitive of norm
// 5^k, so a pixel lies in level l iff x = r_k * y (mod 5^k) with r_k a square root of -1 modulo 5^k: a row is
// walked in steps of 5^k. Departure: splat sides are |Re b| + |Im b|, b = (2 - i)^k, not |b| max(|cos|,
// |sin|), which leaves holes.
#pragma once

#include <cstdint>

namespace saccade::core {

/// Pixels [x0, x1) x [y0, y1).
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  bool operator==(const PixelBox&) const = default;
};

struct Pixel {
  int x = 0, y = 0;
};

class Lattice {
 public:
  static constexpr int kMaxLevel = 7;  ///< level 7 = every pixel; level 1 has spacing sqrt(5)^6 = 125

  /// 5^(kMaxLevel - level): distance of neighbours along a row, and 1 / density.
  static int step(int level);
  /// Odd side of the square splat in pixels: 161, 79, 31, 13, 7, 3, 1 for levels 1..7.
  static int splatSide(int level);
  /// Whether the pixel is a lattice point of the level (of coarser levels too: levels are nested). Any
  /// integers.
  static bool contains(int level, std::int64_t x, std::int64_t y);
  /// The coarsest level (1..kMaxLevel) the pixel belongs to.
  static int levelOf(std::int64_t x, std::int64_t y);
  /// First x >= x0 in row y that is a lattice point of the level.
  static std::int64_t firstInRow(int level, std::int64_t x0, std::int64_t y);
};

/// A place in the walk over a box's lattice points of one level, row by row.
struct LatticeCursor {
  int level = 1;
  std::int64_t y = 0;
  std::int64_t x = 0;
  bool operator==(const LatticeCursor&) const = default;
};

/// Walks the points of `cursor.level` in `box` in row order, starting at the cursor, for at most `maxPoints`
/// lattice points, calling visit(x, y). `omitCoarser` leaves out points of level - 1 (they still count as
/// visited points, so the number of steps does not depend on it). Returns the cursor to go on from; its y is
/// box.y1 when the level is done.
template <class Visit>
LatticeCursor walkLattice(const PixelBox& box, LatticeCursor cursor, std::int64_t maxPoints, bool omitCoarser,
                          Visit&& visit) {
  const int step = Lattice::step(cursor.level);
  const bool omit = omitCoarser && cursor.level > 1;
  while (cursor.y < box.y1) {
    for (; cursor.x < box.x1; cursor.x += step) {
      if (maxPoints-- == 0) return cursor;
      if (!(omit && Lattice::contains(cursor.level - 1, cursor.x, cursor.y))) {
        visit(static_cast<int>(cursor.x), static_cast<int>(cursor.y));
      }
    }
    ++cursor.y;
    cursor.x = Lattice::firstInRow(cursor.level, box.x0, cursor.y);
  }
  return cursor;
}

/// The cursor before the first point of a level in a box.
LatticeCursor beginLevel(const PixelBox& box, int level);

/// Where walkLattice would end, without visiting: time grows with rows, not with points.
LatticeCursor skipLattice(const PixelBox& box, LatticeCursor cursor, std::int64_t points);

}  // namespace saccade::core
