// Haber 2001, section 4.3, against its definition with complex integers: design facts 1 and 2, hard case 25.
#include "core/corrective/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tests/hard_case.h"

namespace saccade::core {
namespace {

using tests::HardCase;

using Gauss = std::complex<std::int64_t>;

Gauss generator(int level) {
  Gauss b{1, 0};
  for (int k = level; k < Lattice::kMaxLevel; ++k) b *= Gauss{2, -1};
  return b;
}

/// (x + iy) / b is a Gaussian integer.
bool divisible(std::int64_t x, std::int64_t y, int level) {
  const Gauss b = generator(level);
  const Gauss quotient = Gauss{x, y} * std::conj(b);
  const std::int64_t norm = std::norm(b);
  return quotient.real() % norm == 0 && quotient.imag() % norm == 0;
}

TEST(Lattice, SidesAndSteps) {
  const int sides[] = {161, 79, 31, 13, 7, 3, 1};
  int step = 1;
  for (int level = Lattice::kMaxLevel; level >= 1; --level, step *= 5) {
    EXPECT_EQ(Lattice::splatSide(level), sides[level - 1]);
    EXPECT_EQ(Lattice::step(level), step);
    EXPECT_EQ(std::norm(generator(level)), step);
  }
}

TEST(Lattice, MembershipIsDivisibilityByThePrime) {
  std::mt19937_64 random(1);
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    for (int y = -70; y < 70; ++y) {
      for (int x = -70; x < 70; ++x) {
        ASSERT_EQ(Lattice::contains(level, x, y), divisible(x, y, level)) << level << ' ' << x << ' ' << y;
      }
    }
    std::uniform_int_distribution<std::int64_t> far(-2'000'000'000, 2'000'000'000);
    for (int i = 0; i < 2000; ++i) {
      const Gauss point = Gauss{far(random), far(random)} * generator(level);
      ASSERT_TRUE(Lattice::contains(level, point.real(), point.imag()));
      const std::int64_t x = far(random), y = far(random);
      ASSERT_EQ(Lattice::contains(level, x, y), divisible(x, y, level));
    }
  }
}

TEST(Lattice, ExtremeIntegersDoNotOverflow) {
  const std::int64_t hi = INT64_MAX, lo = INT64_MIN;
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    const std::int64_t m = Lattice::step(level);
    // The lattice has period m in both directions.
    EXPECT_EQ(Lattice::contains(level, hi, lo), Lattice::contains(level, hi % m, lo % m));
    EXPECT_EQ(Lattice::contains(level, lo, hi), Lattice::contains(level, lo % m, hi % m));
  }
}

TEST(Lattice, LevelsAreNestedAndLevelOfIsTheCoarsest) {
  for (int y = -400; y < 400; ++y) {
    for (int x = -400; x < 400; ++x) {
      const int coarsest = Lattice::levelOf(x, y);
      for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
        ASSERT_EQ(Lattice::contains(level, x, y), level >= coarsest);
      }
    }
  }
  EXPECT_EQ(Lattice::levelOf(0, 0), 1);
  EXPECT_EQ(Lattice::levelOf(1, 0), Lattice::kMaxLevel);
}

TEST(Lattice, EveryRowHasExactlyOnePointPerStep) {
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    const int step = Lattice::step(level);
    for (std::int64_t y : {-15626, -15625, -3, -1, 0, 1, 2, 7, 511, 15624}) {
      for (std::int64_t x0 : {-20000, -1, 0, 1, 333}) {
        const std::int64_t first = Lattice::firstInRow(level, x0, y);
        EXPECT_GE(first, x0);
        EXPECT_LT(first, x0 + step);
        EXPECT_TRUE(Lattice::contains(level, first, y));
      }
    }
    // Walking x alone: density 5^-k along the row, hence in the plane.
    int points = 0;
    for (int x = 0; x < step; ++x) points += Lattice::contains(level, x, 12345);
    EXPECT_EQ(points, 1);
  }
}

std::vector<std::pair<int, int>> walkWhole(const PixelBox& box, int level, bool omit, std::int64_t job) {
  std::vector<std::pair<int, int>> points;
  LatticeCursor cursor = beginLevel(box, level);
  while (cursor.y < box.y1) {
    const LatticeCursor skipped = skipLattice(box, cursor, job);
    cursor = walkLattice(box, cursor, job, omit, [&](int x, int y) { points.emplace_back(x, y); });
    EXPECT_EQ(cursor, skipped);
  }
  return points;
}

/// Pixels of the box that all levels together do not visit exactly once, and visits of another level's pixel.
std::int64_t wrongVisits(const PixelBox& box, std::int64_t job) {
  std::vector<std::uint8_t> visits(static_cast<std::size_t>(box.area()), 0);
  const std::int64_t width = box.x1 - box.x0;
  std::int64_t wrong = 0;
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    for (const auto& [x, y] : walkWhole(box, level, true, job)) {
      ++visits[static_cast<std::size_t>((y - box.y0) * width + x - box.x0)];
      wrong += Lattice::levelOf(x, y) != level;
    }
  }
  for (const std::uint8_t n : visits) wrong += n != 1;
  return wrong;
}

TEST(WalkLattice, Hard25LevelsTogetherVisitEveryPixelOnceForAnyBoxAndJobSize) {
  HardCase wrong =
      HardCase::counting("pixels of boxes of any size and offset not visited exactly once", "pixels");
  std::vector<PixelBox> boxes = {{0, 0, 1, 1},     {0, 0, 3, 5},      {-7, -9, 40, 33}, {5, 5, 205, 155},
                                 {0, 0, 200, 150}, {-3, 60, -2, 300}, {11, 0, 411, 1}};
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const int x = static_cast<int>(random() % 40001) - 20000, y = static_cast<int>(random() % 40001) - 20000;
    boxes.push_back(
        {x, y, x + 1 + static_cast<int>(random() % 300), y + 1 + static_cast<int>(random() % 200)});
  }
  for (const PixelBox& box : boxes) {
    for (std::int64_t job : {1, 7, 64, 1 << 20}) {
      if (job == 1 && box.area() > 2000) continue;
      EXPECT_TRUE(wrong.within(static_cast<double>(wrongVisits(box, job)), 0)) << box.x0 << ", " << box.y0;
    }
  }
}

TEST(WalkLattice, Hard21LevelsTogetherVisitEveryPixelOnceOfTheLargestImage) {
  // Per pixel a bit; the visits add up to the area only when none comes twice.
  HardCase wrong = HardCase::counting("pixels of 8192^2 and 16384^2 not visited exactly once", "pixels");
  for (const int side : {8192, 16384}) {
    const PixelBox box{0, 0, side, side};
    std::vector<bool> seen(static_cast<std::size_t>(box.area()));
    std::int64_t twice = 0, visits = 0;
    for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
      walkLattice(box, beginLevel(box, level), box.area(), true, [&](int x, int y) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
        twice += seen[i];
        seen[i] = true;
        ++visits;
      });
    }
    EXPECT_TRUE(wrong.within(static_cast<double>(twice + std::abs(box.area() - visits)), 0)) << side;
  }
}

TEST(WalkLattice, StepsDoNotDependOnOmission) {
  const PixelBox box{3, 2, 120, 90};
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    LatticeCursor with = beginLevel(box, level), without = with;
    while (with.y < box.y1) {
      with = walkLattice(box, with, 13, true, [](int, int) {});
      without = walkLattice(box, without, 13, false, [](int, int) {});
      ASSERT_EQ(with, without);
    }
  }
}

TEST(WalkLattice, VisitsInRowOrder) {
  const PixelBox box{-5, -5, 60, 50};
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    const auto points = walkWhole(box, level, false, 11);
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_LT(std::pair(points[i - 1].second, points[i - 1].first),
                std::pair(points[i].second, points[i].first));
    }
  }
}

TEST(WalkLattice, EmptyBoxAndNoPoints) {
  const PixelBox empty{4, 4, 4, 9};
  const LatticeCursor end = walkLattice(empty, beginLevel(empty, 7), 100, false, [](int, int) { FAIL(); });
  EXPECT_EQ(end.y, empty.y1);
  const PixelBox box{0, 0, 9, 9};
  EXPECT_EQ(walkLattice(box, beginLevel(box, 7), 0, false, [](int, int) { FAIL(); }), beginLevel(box, 7));
}

/// Bare pixels of one period of a level's lattice: with period 5^k in x and one point a row, a pixel (x,
/// y) is covered iff some row y + d, |d| <= side / 2, has a point within side / 2 in x. By translation along
/// the lattice it is enough to look at row 0.
std::ptrdiff_t holes(int level, int side) {
  const int half = side / 2, step = Lattice::step(level);
  std::vector<char> row(static_cast<std::size_t>(step), 0);
  for (int dy = -half; dy <= half; ++dy) {
    const auto center = static_cast<int>(Lattice::firstInRow(level, 0, dy));
    for (int dx = -half; dx <= half; ++dx) row[((center + dx) % step + step) % step] = 1;
  }
  return std::count(row.begin(), row.end(), 0);
}

TEST(Splats, Hard25CoverThePlaneAtEveryLevelAndNoSmallerOddSideDoes) {
  HardCase bare = HardCase::counting("holes of the splat cover at every level", "pixels");
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    const int side = Lattice::splatSide(level);
    EXPECT_EQ(side % 2, 1);
    EXPECT_TRUE(bare.within(static_cast<double>(holes(level, side)), 0)) << level;
    if (side > 1) {
      EXPECT_GT(holes(level, side - 2), 0) << level;
    }
  }
}

TEST(Splats, NoCoarserOrEqualSampleCentreIsOverwritten) {
  // Differences of lattice points are lattice points, so it is enough to look around the origin: a splat of
  // level f may hold no other point of level f, nor of any coarser level (they are nested).
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    const int half = Lattice::splatSide(level) / 2;
    for (int y = -half; y <= half; ++y) {
      for (int x = -half; x <= half; ++x) {
        if (x != 0 || y != 0) {
          ASSERT_FALSE(Lattice::contains(level, x, y)) << level << ' ' << x << ' ' << y;
        }
      }
    }
  }
}

/// Pixels of a 150 x 150 image that no splat of levels 1..last touches, whole plane (centres outside the
/// image count). A splat of even side reaches one pixel farther to the left and the top.
template <class SideOf>
int bareAfter(int last, SideOf sideOf) {
  constexpr int kSize = 150;
  std::vector<char> covered(std::size_t{kSize} * kSize, 0);
  for (int level = 1; level <= last; ++level) {
    const int side = sideOf(level);
    const PixelBox box{-side, -side, kSize + side, kSize + side};
    walkLattice(box, beginLevel(box, level), box.area(), false, [&](int cx, int cy) {
      const int left = cx - side / 2, top = cy - side / 2;
      for (int y = std::max(0, top); y < std::min(kSize, top + side); ++y) {
        for (int x = std::max(0, left); x < std::min(kSize, left + side); ++x) covered[y * kSize + x] = 1;
      }
    });
  }
  return static_cast<int>(std::count(covered.begin(), covered.end(), 0));
}

TEST(Splats, ThePapersSideLeavesHolesOurSideNone) {
  // |b| max(|cos|, |sin|) = max(|Re b|, |Im b|). Level 6 of the paper has the even side 2.
  const auto paper = [](int level) {
    const Gauss b = generator(level);
    return static_cast<int>(std::max(std::abs(b.real()), std::abs(b.imag())));
  };
  EXPECT_EQ(bareAfter(1, paper), 2728);
  EXPECT_EQ(bareAfter(6, paper), 1);
  EXPECT_EQ(bareAfter(7, paper), 0);
  EXPECT_EQ(bareAfter(1, Lattice::splatSide), 0);
}

}  // namespace
}  // namespace saccade::core
