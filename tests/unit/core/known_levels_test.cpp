// What a warped sample is still worth, against the formula in floating point.
#include "core/corrective/known_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/corrective/lattice.h"

namespace saccade::core {
namespace {

TEST(EffectiveLevel, IsTheNearestLevelOfSpacingAndDriftTogether) {
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    for (int age = 0; age < 400; ++age) {
      const double variance = Lattice::step(level) + 0.25 * age * age;
      const double exact = Lattice::kMaxLevel - std::log(variance) / std::log(5.0);
      const int nearest = std::max(1, static_cast<int>(std::lround(exact)));
      EXPECT_EQ(effectiveLevel(level, age), nearest) << level << " after " << age;
    }
  }
}

TEST(EffectiveLevel, NeverRises) {
  for (int level = 1; level <= Lattice::kMaxLevel; ++level) {
    EXPECT_EQ(effectiveLevel(level, 0), level);
    for (int age = 1; age < 400; ++age) {
      EXPECT_LE(effectiveLevel(level, age), effectiveLevel(level, age - 1));
      if (level > 1) {
        EXPECT_LE(effectiveLevel(level - 1, age), effectiveLevel(level, age));
      }
    }
    EXPECT_EQ(effectiveLevel(level, std::numeric_limits<std::int64_t>::max()), 1);
  }
}

}  // namespace
}  // namespace saccade::core
