// The queue of sample regions: every pixel once, an order that is a function of frame and priorities, and
// threads that always come home.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>
#include <tuple>

#include "core/corrective/queues.h"
#include "tests/unit/core/mask_frame.h"

namespace saccade::core {
namespace {

using namespace std::chrono_literals;
using tests::frameOf;
using tests::randomMask;

using JobKey = std::tuple<std::uint32_t, int, std::int64_t, std::int64_t, std::int64_t, bool, float>;
JobKey keyOf(const Job& j) {
  return {j.id, j.begin.level, j.begin.y, j.begin.x, j.points, j.omitCoarser, j.priority};
}

std::vector<Job> drain(RegionQueue& queue) {
  std::vector<Job> jobs;
  while (auto job = queue.tryPop()) jobs.push_back(std::move(*job));
  return jobs;
}

std::vector<float> randomPriorities(std::uint32_t idCount, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> priorities(idCount + 1);
  for (float& p : priorities) p = static_cast<float>(1 + random() % 1000) / 1000.0f;
  return priorities;
}

/// Two squares of equal size whose lattices differ, and a third object of one pixel.
FramePtr twoSquares() {
  constexpr int kWidth = 150, kHeight = 64;
  std::vector<std::uint32_t> ids(kWidth * kHeight, 0);
  for (int y = 2; y < 62; ++y) {
    for (int x = 0; x < 60; ++x) ids[y * kWidth + x] = 1, ids[y * kWidth + x + 80] = 2;
  }
  ids[kWidth - 1] = 3;
  return frameOf(kWidth, kHeight, ids, 3);
}

TEST(RegionQueue, HandsOutEveryMaskPixelExactlyOnce) {
  struct Case {
    int width, height;
    std::uint32_t ids;
  };
  for (const Case& c : {Case{1, 1, 1}, Case{2, 1, 1}, Case{3, 5, 3}, Case{64, 1, 5}, Case{97, 61, 12},
                        Case{200, 150, 9}, Case{120, 80, 1000}}) {
    for (int jobSize : {1, 7, 64, 100000}) {
      const auto frame = frameOf(c.width, c.height, randomMask(c.width, c.height, c.ids, 3), c.ids);
      std::vector<int> visits(frame->baseAndId.size(), 0);
      RegionQueue queue(jobSize);
      queue.setPriorities(randomPriorities(c.ids, 8));
      queue.beginFrame(frame);
      while (auto job = queue.tryPop()) {
        forEachPixel(*job, [&](int x, int y) { ++visits[frame->index(x, y)]; });
      }
      EXPECT_TRUE(queue.exhausted());
      for (std::size_t i = 0; i < visits.size(); ++i) {
        ASSERT_EQ(visits[i], frame->baseAndId[i].w != 0 ? 1 : 0)
            << c.width << 'x' << c.height << " job " << jobSize;
      }
    }
  }
}

/// Of discs and speckles, 0 to one more than the finest level.
KnownLevels randomKnown(const FrameSnapshot& frame, std::uint32_t seed) {
  std::vector<std::uint8_t> known;
  for (const std::uint32_t level : randomMask(frame.view.width(), frame.view.height(), 8, seed))
    known.push_back(static_cast<std::uint8_t>(level));
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(known));
}

TEST(RegionQueue, AKnownPixelWaitsForTheFirstFinerLevel) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    for (const int jobSize : {1, 64, 100000}) {
      const auto frame = frameOf(180, 130, randomMask(180, 130, 7, seed), 7);
      const KnownLevels known = randomKnown(*frame, seed + 10);
      RegionQueue queue(jobSize);
      queue.setPriorities(randomPriorities(7, seed));
      queue.beginFrame(frame, {}, known);
      std::vector<int> visits(frame->ids.size(), 0);
      for (const Job& job : drain(queue)) {
        forEachPixel(job, [&](int x, int y) {
          const std::size_t i = frame->index(x, y);
          ++visits[i];
          const int best = (*known)[i], finer = best + 1;
          const int first = std::max({Lattice::levelOf(x, y), frame->extents[job.id].startLevel, finer});
          EXPECT_EQ(job.refresh, best >= Lattice::kMaxLevel);
          EXPECT_EQ(job.begin.level, std::min(first, Lattice::kMaxLevel));
        });
      }
      EXPECT_TRUE(queue.exhausted());
      for (std::size_t i = 0; i < visits.size(); ++i) ASSERT_EQ(visits[i], frame->ids[i] != 0 ? 1 : 0);
    }
  }
}

TEST(RegionQueue, NothingKnownIsAsNoKnowledge) {
  const auto frame = frameOf(180, 130, randomMask(180, 130, 7, 5), 7);
  using Visit = std::tuple<int, int, int>;
  std::vector<Visit> visits[2];
  for (const bool told : {false, true}) {
    RegionQueue queue(64);
    queue.setPriorities(randomPriorities(7, 5));
    queue.beginFrame(frame, {},
                     told ? std::make_shared<const std::vector<std::uint8_t>>(frame->ids.size()) : nullptr);
    for (const Job& job : drain(queue))
      forEachPixel(job, [&](int x, int y) { visits[told].push_back({job.begin.level, x, y}); });
  }
  EXPECT_EQ(visits[0], visits[1]);
}

TEST(RegionQueue, RefreshingIsOneLevelMoreToInhibition) {
  const auto frame = twoSquares();
  RegionQueue queue(64);
  queue.beginFrame(frame, {}, std::make_shared<const std::vector<std::uint8_t>>(frame->ids.size(), 7));
  for (const Job& job : drain(queue)) {
    const int reductions = job.begin.level - 1 + (job.refresh ? 1 : 0);
    EXPECT_EQ(job.priority, std::ldexp(1.0f, -reductions));
  }
}

TEST(RegionQueue, LevelsOfAnObjectComeInOrderFromItsStartLevel) {
  const auto frame = frameOf(200, 150, randomMask(200, 150, 6, 4), 6);
  RegionQueue queue(32);
  queue.beginFrame(frame);
  std::vector<int> level(7, 0);
  for (const Job& job : drain(queue)) {
    const int start = frame->extents[job.id].startLevel;
    if (level[job.id] == 0) {
      EXPECT_EQ(job.begin.level, start);
    }
    EXPECT_GE(job.begin.level, level[job.id]);
    EXPECT_LE(job.begin.level, std::max(level[job.id], start) + 1);
    EXPECT_EQ(job.omitCoarser, job.begin.level > start);
    level[job.id] = job.begin.level;
  }
  for (int id = 1; id <= 6; ++id) EXPECT_EQ(level[id], Lattice::kMaxLevel);
}

TEST(RegionQueue, AJobHasAboutJobSizePixels) {
  // A ring: the mask fills a small part of its box.
  constexpr int kSize = 200, kJob = 64;
  std::vector<std::uint32_t> ids(kSize * kSize, 0);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double r = std::hypot(x - 100, y - 100);
      ids[y * kSize + x] = r > 85 && r < 95;
    }
  }
  const auto frame = frameOf(kSize, kSize, ids, 1);
  RegionQueue queue(kJob);
  queue.beginFrame(frame);
  std::size_t pixels = 0, jobs = 0;
  for (const Job& job : drain(queue)) {
    if (job.begin.level < Lattice::kMaxLevel) continue;
    ++jobs;
    forEachPixel(job, [&](int, int) { ++pixels; });
  }
  // The last level omits a fifth of its points, which still count.
  EXPECT_NEAR(static_cast<double>(pixels) / static_cast<double>(jobs), 0.8 * kJob, 0.05 * kJob);
}

TEST(RegionQueue, PrioritiesDecideAndTiesGoToTheSmallerId) {
  const auto frame = frameOf(120, 80, randomMask(120, 80, 8, 2), 8);
  RegionQueue queue(16);
  queue.setPriorities(randomPriorities(8, 77));
  queue.beginFrame(frame);
  // Priorities only fall: no region is ever raised, so the order handed out is non-increasing.
  const auto jobs = drain(queue);
  ASSERT_GT(jobs.size(), 50u);
  for (std::size_t i = 1; i < jobs.size(); ++i) {
    EXPECT_LE(jobs[i].priority, jobs[i - 1].priority);
    if (jobs[i].priority == jobs[i - 1].priority) {
      EXPECT_GE(jobs[i].id, jobs[i - 1].id);
    }
    EXPECT_EQ(jobs[i].sequence, i);
  }
}

TEST(RegionQueue, TenPercentRuleMakesEqualObjectsAlternateByLevel) {
  RegionQueue queue(32, 0.1f);
  queue.setPriorities(std::vector<float>{0, 0.8f, 0.8f, 0.01f});
  queue.beginFrame(twoSquares());
  std::vector<std::pair<int, std::uint32_t>> runs;
  for (const Job& job : drain(queue)) {
    if (job.id == 3) continue;
    const std::pair<int, std::uint32_t> run{job.begin.level, job.id};
    if (runs.empty() || runs.back() != run) runs.push_back(run);
    EXPECT_FLOAT_EQ(job.priority, 0.8f * std::pow(0.9f, static_cast<float>(job.begin.level - 1)));
  }
  const std::vector<std::pair<int, std::uint32_t>> expected{{4, 1}, {4, 2}, {5, 1}, {5, 2},
                                                            {6, 1}, {6, 2}, {7, 1}, {7, 2}};
  EXPECT_EQ(runs, expected);
}

TEST(RegionQueue, WithoutInhibitionTheWinnerTakesAll) {
  const auto frame = frameOf(120, 80, randomMask(120, 80, 8, 2), 8);
  const std::vector<float> priorities = randomPriorities(8, 77);
  RegionQueue queue(16, 0);
  queue.setPriorities(priorities);
  queue.beginFrame(frame);
  std::vector<std::uint32_t> ids;
  for (const Job& job : drain(queue)) {
    EXPECT_EQ(job.priority, priorities[job.id]) << "nothing is lost with a level";
    if (ids.empty() || ids.back() != job.id) ids.push_back(job.id);
  }
  ASSERT_EQ(ids.size(), 8u) << "each is corrected in one go";
  for (std::size_t i = 1; i < ids.size(); ++i) EXPECT_GE(priorities[ids[i - 1]], priorities[ids[i]]);
}

TEST(RegionQueue, StrongInhibitionGoesLevelByLevelThroughAllObjects) {
  const auto frame = frameOf(120, 80, randomMask(120, 80, 8, 2), 8);
  RegionQueue queue(16, 0.9f);
  queue.setPriorities(std::vector<float>{0, 0.2f, 0.9f, 0.3f, 0.4f, 0.5f, 0.6f, 1.0f, 0.8f});
  queue.beginFrame(frame);
  int level = 1;
  std::uint32_t last = 0;
  const float priorities[] = {0, 0.2f, 0.9f, 0.3f, 0.4f, 0.5f, 0.6f, 1.0f, 0.8f};
  for (const Job& job : drain(queue)) {
    EXPECT_GE(job.begin.level, level);
    if (job.begin.level == level && last != 0) {
      EXPECT_LE(priorities[job.id], priorities[last]);
    }
    level = job.begin.level, last = job.id;
  }
  EXPECT_EQ(level, Lattice::kMaxLevel);
}

TEST(RegionQueue, WhatExceedsOneIsNotInhibited) {
  const auto frame = twoSquares();
  RegionQueue queue(16, 0.9f);
  queue.setPriorities(std::vector<float>{0, 1, 2, 1});
  queue.beginFrame(frame);
  std::size_t pixels = 0;
  std::optional<Job> job = queue.tryPop();
  for (; job->id == 2; job = queue.tryPop()) forEachPixel(*job, [&](int, int) { ++pixels; });
  EXPECT_EQ(pixels, frame->extents[2].pixels) << "all of it before anything of the others";
}

TEST(RegionQueue, GainsAreFactorsOfWhatIsInhibited) {
  const auto frame = twoSquares();
  RegionQueue queue(16, 0.5f);
  queue.setPriorities(std::vector<float>{0, 0.9f, 0.5f, 0.4f});
  queue.beginFrame(frame, {1, 0.5f});  // 2 and 3 have 1
  EXPECT_EQ(queue.tryPop()->id, 2u);
  for (const Job& job : drain(queue)) {
    const float gained = job.id == 1 ? 0.45f : job.id == 2 ? 0.5f : 0.4f;
    EXPECT_FLOAT_EQ(job.priority, gained * std::pow(0.5f, static_cast<float>(job.begin.level - 1)));
  }
  queue.beginFrame(frame);
  EXPECT_EQ(queue.tryPop()->id, 1u) << "gains are of one frame";
  queue.setPriorities(std::vector<float>{0, 2, 0.5f, 0.4f});
  queue.beginFrame(frame, {1, 1e-3f});
  EXPECT_EQ(queue.tryPop()->id, 1u) << "a click counts whole";
}

TEST(RegionQueue, RanksSayWhoIsNext) {
  RegionQueue queue(16);
  EXPECT_TRUE(queue.ranks().empty());
  const auto frame = frameOf(120, 80, randomMask(120, 80, 8, 2), 9);  // 9 is not visible
  queue.setPriorities(randomPriorities(9, 77));
  queue.beginFrame(frame);
  using Ranks = std::vector<std::uint32_t>;
  while (!queue.exhausted()) {
    const Ranks ranks = queue.ranks();
    ASSERT_EQ(ranks.size(), 10u);
    EXPECT_EQ(ranks[0], 0u);
    EXPECT_EQ(ranks[9], 0u);
    EXPECT_EQ(ranks[queue.tryPop()->id], 1u);
    Ranks left = ranks;
    left.erase(std::remove(left.begin(), left.end(), 0u), left.end());
    std::sort(left.begin(), left.end());
    for (std::size_t i = 0; i < left.size(); ++i) ASSERT_EQ(left[i], i + 1) << "no rank twice, none left out";
  }
  EXPECT_EQ(queue.ranks(), Ranks(10, 0));
}

TEST(RegionQueue, NewPrioritiesKeepProgressAndReapplyReductions) {
  const auto frame = twoSquares();
  constexpr float kInhibition = 0.1f;
  const auto reduced = [](float priority, int level) {
    return priority * std::pow(1 - kInhibition, static_cast<float>(level - 1));
  };
  RegionQueue changed(32, kInhibition), untouched(32, kInhibition);
  for (RegionQueue* q : {&changed, &untouched}) {
    q->setPriorities(std::vector<float>{0, 0.9f, 0.5f, 0.4f});
    q->beginFrame(frame);
  }
  std::vector<JobKey> a, b;
  while (auto job = changed.tryPop()) {
    a.push_back(keyOf(*job));
    changed.setPriorities(std::vector<float>{0, 0.9f, 0.5f, 0.4f});  // the same ones: nothing may change
  }
  for (const Job& job : drain(untouched)) b.push_back(keyOf(job));
  EXPECT_EQ(a, b);

  RegionQueue swapped(32, kInhibition);
  swapped.setPriorities(std::vector<float>{0, 0.9f, 0.5f, 0.4f});
  swapped.beginFrame(frame);
  while (swapped.tryPop()->begin.level < 5) {
  }
  swapped.setPriorities(std::vector<float>{0, 0.5f, 1.0f});  // 3 keeps its own
  const Job next = *swapped.tryPop();
  EXPECT_EQ(next.id, 2u);
  EXPECT_FLOAT_EQ(next.priority, reduced(1, next.begin.level));
  float ofFirst = 0;
  int firstLevel = 0;
  for (const Job& job : drain(swapped)) {
    if (job.id != 1 || firstLevel != 0) continue;
    ofFirst = job.priority, firstLevel = job.begin.level;
  }
  EXPECT_EQ(firstLevel, 5);
  EXPECT_FLOAT_EQ(ofFirst, reduced(0.5f, 5));
}

TEST(RegionQueue, StrangePrioritiesAreTamed) {
  RegionQueue queue(1000, 0);
  queue.setPriorities(std::vector<float>{0, std::numeric_limits<float>::quiet_NaN(), -3, 70});
  queue.beginFrame(twoSquares());
  const auto jobs = drain(queue);
  EXPECT_EQ(jobs.front().id, 3u);
  EXPECT_EQ(jobs.front().priority, RegionQueue::kHighestPriority);
  EXPECT_EQ(jobs[1].id, 1u);
  EXPECT_EQ(jobs[1].priority, RegionQueue::kLowestPriority);
}

TEST(RegionQueue, NewFrameStartsAgainAndNumbersByEpoch) {
  const auto ids = randomMask(50, 40, 3, 6);
  RegionQueue queue(16);
  queue.beginFrame(frameOf(50, 40, ids, 3, 10, 1));
  std::vector<JobKey> first, second;
  for (int i = 0; i < 5; ++i) first.push_back(keyOf(*queue.tryPop()));
  queue.beginFrame(frameOf(50, 40, ids, 3, 10, 1));
  EXPECT_EQ(queue.tryPop()->sequence, 5u);
  queue.beginFrame(frameOf(50, 40, ids, 3, 10, 2));
  for (std::uint64_t i = 0; i < 5; ++i) {
    const Job job = *queue.tryPop();
    EXPECT_EQ(job.sequence, i);
    EXPECT_EQ(job.frame->epoch, 2u);
    second.push_back(keyOf(job));
  }
  EXPECT_EQ(first, second);
}

TEST(RegionQueue, OrderDoesNotDependOnTheNumberOfPoppers) {
  const auto frame = frameOf(200, 150, randomMask(200, 150, 40, 11), 40);
  const auto priorities = randomPriorities(40, 12);
  const auto inSequence = [&](int threads) {
    RegionQueue queue(16);
    queue.setPriorities(priorities);
    queue.beginFrame(frame);
    std::vector<std::vector<Job>> taken(static_cast<std::size_t>(threads));
    {
      std::vector<std::jthread> poppers;
      for (auto& mine : taken) poppers.emplace_back([&] { mine = drain(queue); });
    }
    std::vector<Job> jobs;
    for (auto& mine : taken) jobs.insert(jobs.end(), mine.begin(), mine.end());
    std::sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.sequence < b.sequence; });
    std::vector<JobKey> keys;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      EXPECT_EQ(jobs[i].sequence, i);
      keys.push_back(keyOf(jobs[i]));
    }
    return keys;
  };
  const auto inlineOrder = inSequence(1);
  EXPECT_GT(inlineOrder.size(), 500u);
  for (int threads : {2, 3, 8}) EXPECT_EQ(inSequence(threads), inlineOrder) << threads;
}

TEST(RegionQueue, CloseWakesWaitersAndStopsWork) {
  RegionQueue queue(16);
  std::atomic<int> home = 0;
  {
    std::vector<std::jthread> waiters;
    for (int i = 0; i < 4; ++i) {
      waiters.emplace_back([&] {
        EXPECT_FALSE(queue.pop());
        ++home;
      });
    }
    queue.close();
  }
  EXPECT_EQ(home, 4);
  queue.beginFrame(twoSquares());
  EXPECT_FALSE(queue.tryPop());
  EXPECT_FALSE(queue.pop());
}

TEST(RegionQueue, PopWaitsForAFrame) {
  RegionQueue queue(1 << 20);
  std::uint32_t id = 0;
  {
    std::jthread waiter([&] { id = queue.pop()->id; });
    queue.beginFrame(twoSquares());
  }
  EXPECT_EQ(id, 1u);
  EXPECT_FALSE(queue.exhausted());
}

}  // namespace
}  // namespace saccade::core
