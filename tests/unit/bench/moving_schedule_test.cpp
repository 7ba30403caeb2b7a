// Where the frames of a timed walk stand.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/moving/schedule.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr double kBudgets[] = {0.008, 0.016, 0.033, 0.066, 0.125};

TEST(MovingSchedule, EveryBudgetHitsTheSameKeyViewsExactly) {
  for (const Stretch& stretch : {Stretch{5.25, 0.5, 3}, Stretch{0.1, 0.3, 7}, Stretch{0, 0.25, 3}}) {
    const Schedule keyViews(stretch, stretch.segment);
    ASSERT_EQ(keyViews.frames(), stretch.segments + 1);
    for (const double budget : kBudgets) {
      const Schedule schedule(stretch, budget);
      ASSERT_EQ(schedule.keyViews(), stretch.segments);
      for (int k = 0; k < schedule.keyViews(); ++k) {
        const int frame = schedule.frameOf(k);
        EXPECT_EQ(schedule.keyView(frame), k);
        EXPECT_EQ(schedule.seconds(frame), keyViews.seconds(k + 1)) << budget << " s, key view " << k;
      }
      EXPECT_EQ(schedule.frameOf(stretch.segments - 1), schedule.frames() - 1);
    }
  }
}

TEST(MovingSchedule, StepsAreEvenAndWithinASegmentsRoundingOfTheBudget) {
  const Stretch stretch{5.25, 0.5, 3};
  for (const double budget : kBudgets) {
    const Schedule schedule(stretch, budget);
    const double step = stretch.segment / std::round(stretch.segment / budget);
    EXPECT_EQ(schedule.seconds(0), stretch.begin);
    for (int i = 1; i < schedule.frames(); ++i)
      EXPECT_NEAR(schedule.seconds(i) - schedule.seconds(i - 1), step, 1e-12);
    EXPECT_NEAR(step / budget, 1, 0.5 * budget / stretch.segment + 1e-12);
  }
}

TEST(MovingSchedule, KeyViewsAreCountedOnceAndTheColdFrameIsNone) {
  const Schedule schedule({1, 0.5, 3}, 0.066);
  int found = 0;
  for (int i = 0; i < schedule.frames(); ++i) found += schedule.keyView(i) >= 0 ? 1 : 0;
  EXPECT_EQ(found, 3);
  EXPECT_EQ(schedule.keyView(0), -1);
}

TEST(MovingSchedule, ABudgetBeyondTheSegmentStepsFromKeyViewToKeyView) {
  const Schedule schedule({0, 0.5, 2}, 5);
  EXPECT_EQ(schedule.frames(), 3);
  EXPECT_EQ(schedule.seconds(2), 1);
}

TEST(MovingStretch, LiesInTheMiddleOfThePath) {
  const Stretch stretch = Stretch::within(12, 0.5, 3);
  EXPECT_EQ(stretch.begin, 5.25);
  EXPECT_EQ(stretch.segment, 0.5);
  EXPECT_EQ(stretch.segments, 3);
}

TEST(MovingStretch, ShortPathsAreWalkedAsFarAsTheyGo) {
  const Stretch two = Stretch::within(1.2, 0.5, 3), one = Stretch::within(0.3, 0.5, 3);
  EXPECT_EQ(two.segments, 2);
  EXPECT_NEAR(two.begin, 0.1, 1e-12);
  EXPECT_EQ(one.segments, 1);
  EXPECT_EQ(one.segment, 0.3);
  EXPECT_EQ(one.begin, 0);
  EXPECT_THROW(Stretch::within(0, 0.5, 3), core::Error);
}

}  // namespace
}  // namespace saccade::bench
