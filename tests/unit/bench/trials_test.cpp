// The order of repeats, ratios, and the watch for other load.
#include "bench/harness/trials.h"

#include <gtest/gtest.h>

#include <utility>

#include "bench/harness/machine.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

TEST(Trials, WarmUpFirstThenEveryRoundInTheOtherOrder) {
  std::vector<std::pair<int, int>> calls;
  alternate(3, 2, {}, [&](int variant, int round) { calls.emplace_back(round, variant); });
  const std::vector<std::pair<int, int>> expected = {{-1, 2}, {-1, 1}, {-1, 0}, {0, 0}, {0, 1},
                                                     {0, 2},  {1, 2},  {1, 1},  {1, 0}};
  EXPECT_EQ(calls, expected);
}

TEST(Trials, StopsBetweenTwoMeasurements) {
  std::stop_source stop;
  int calls = 0;
  EXPECT_THROW(alternate(2, 5, stop.get_token(),
                         [&](int, int) {
                           if (++calls == 3) stop.request_stop();
                         }),
               core::Error);
  EXPECT_EQ(calls, 3);
}

TEST(Trials, RatiosAreOfTheSameRound) { EXPECT_EQ(ratios({2, 9}, {1, 3}), (std::vector<double>{2, 3})); }

TEST(LoadWatch, ShareIsWithinBoundsOrUnknown) {
  const LoadWatch watch;
  const Clock::time_point start = Clock::now();
  while (secondsSince(start) < 0.3) {
  }
  const auto share = watch.othersShare();
  if (!share) GTEST_SKIP() << "the kernel does not tell how busy it is";
  EXPECT_GE(*share, 0);
  EXPECT_LE(*share, 1);
}

TEST(Machine, DescribesItself) {
  const RunInfo run = describeRun("saccade bench quick -o out", 3);
  EXPECT_FALSE(run.commit.empty());
  EXPECT_EQ(run.seed, 3u);
  EXPECT_GT(run.cores, 0);
  EXPECT_GT(run.memoryBytes, 0u);
  EXPECT_EQ(run.started.size(), 20u);
}

TEST(Machine, PinningEndsWithItsScope) {
  const std::vector<int> all = workerCores(1000);
  {
    const Pinned pinned(mainCores());
    EXPECT_EQ(mainCores().size(), 1u);
  }
  EXPECT_EQ(workerCores(1000), all);
}

}  // namespace
}  // namespace saccade::bench
