#include "attention/attended.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade::attention {
namespace {

constexpr double kHalfLife = AttendedObjects::kHalfLifeSeconds;
constexpr float kHeight = AttendedObjects::kHeight;

TEST(AttendedObjects, HalveWithEachHalfLifeUntilNothingIsLeft) {
  AttendedObjects attended;
  attended.attend(2, 50);
  for (int halfLives = 0; halfLives < AttendedObjects::kHalfLives; ++halfLives) {
    const auto added = attended.at(50 + halfLives * kHalfLife, 4);
    ASSERT_EQ(added.size(), 4u);
    EXPECT_FLOAT_EQ(added[2], kHeight * std::exp2(-static_cast<float>(halfLives)));
    for (const std::size_t other : {0, 1, 3}) EXPECT_EQ(added[other], 0);
  }
  EXPECT_TRUE(attended.at(50 + AttendedObjects::kHalfLives * kHalfLife, 4).empty());
  EXPECT_TRUE(attended.at(50, 4).empty()) << "what has decayed is forgotten";
}

TEST(AttendedObjects, TheLaterOfTwoIsAheadAndASecondClickBeginsAgain) {
  AttendedObjects attended;
  attended.attend(1, 0);
  attended.attend(3, 1);
  auto added = attended.at(1.5, 4);
  EXPECT_GT(added[3], added[1]);
  EXPECT_GT(added[1], 0);
  attended.attend(1, 2);
  added = attended.at(2, 4);
  EXPECT_EQ(added[1], kHeight);
  EXPECT_LT(added[3], added[1]);
}

TEST(AttendedObjects, NoneAndWhatIsOutOfRangeAddNothing) {
  AttendedObjects attended;
  EXPECT_TRUE(attended.at(0, 4).empty());
  attended.attend(0, 0);
  attended.attend(4, 0);
  EXPECT_TRUE(attended.at(0, 4).empty());
  EXPECT_EQ(attended.at(0, 5)[4], kHeight);
  EXPECT_TRUE(attended.at(0, 0).empty());
  // A clock of another core that lags a little: no more than the height.
  EXPECT_EQ(attended.at(-1, 5)[4], kHeight);
}

}  // namespace
}  // namespace saccade::attention
