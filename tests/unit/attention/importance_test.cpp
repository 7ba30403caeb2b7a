#include "attention/importance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/error.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

using core::ImageGray;
using tests::makeFrame;

constexpr int kWidth = 200, kHeight = 100;

// 1 in a corner, 2 in the middle, 3 large at the right, 5 at the bottom; 4 is not visible.
std::shared_ptr<core::FrameSnapshot> fourObjects() {
  return makeFrame(
      kWidth, kHeight,
      {{1, {0, 0, 10, 10}}, {2, {95, 45, 105, 55}}, {3, {140, 5, 200, 85}}, {5, {20, 90, 50, 100}}}, 5);
}

ImageGray salientOnlyAt(std::uint32_t id, const core::FrameSnapshot& frame) {
  ImageGray map(frame.view.width(), frame.view.height(), 0.0f);
  for (std::size_t i = 0; i < map.pixels().size(); ++i)
    map.pixels()[i] = frame.ids[i] == static_cast<float>(id) ? 0.8f : 0.1f;
  return map;
}

std::vector<std::uint32_t> ranking(const std::vector<float>& priority) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 1; id < priority.size(); ++id) {
    if (priority[id] > 0) ids.push_back(id);
  }
  std::stable_sort(ids.begin(), ids.end(), [&](auto a, auto b) { return priority[a] > priority[b]; });
  return ids;
}

TEST(ObjectSaliency, IsTheMeanOverTheMask) {
  const auto frame = fourObjects();
  ImageGray map(kWidth, kHeight, 0.0f);
  for (int y = 45; y < 55; ++y) {
    for (int x = 95; x < 100; ++x) map.at(x, y) = 0.6f;  // half of object 2
  }
  const std::vector<float> saliency = objectSaliency(*frame, map);
  ASSERT_EQ(saliency.size(), 6u);
  EXPECT_FLOAT_EQ(saliency[2], 0.3f);
  for (const std::size_t id : {0, 1, 3, 4, 5}) EXPECT_EQ(saliency[id], 0.0f);
}

TEST(ObjectSaliency, RefusesAMapOfAnotherSizeAndUnknownObjects) {
  const auto frame = fourObjects();
  EXPECT_THROW(objectSaliency(*frame, ImageGray(kWidth, kHeight + 1)), core::Error);
  frame->ids[0] = 6;
  EXPECT_THROW(objectSaliency(*frame, ImageGray(kWidth, kHeight)), core::Error);
}

TEST(TaskImportance, OfKnownBoxes) {
  const std::vector<float> task = taskImportance(*fourObjects());
  const double all = kWidth * kHeight, diagonal = std::hypot(kWidth / 2.0, kHeight / 2.0);
  EXPECT_EQ(task[4], 0.0f);
  EXPECT_NEAR(task[2], 0.5 * (1 + std::sqrt(100 / all)), 1e-6);
  EXPECT_NEAR(task[1], 0.5 * (1 - std::hypot(95.0, 45.0) / diagonal + std::sqrt(100 / all)), 1e-6);
  EXPECT_NEAR(task[3], 0.5 * (1 - std::hypot(70.0, 5.0) / diagonal + std::sqrt(4800 / all)), 1e-6);
  // Everything in one object: as important as can be.
  EXPECT_FLOAT_EQ(taskImportance(*makeFrame(30, 20, {{1, {0, 0, 30, 20}}}, 1))[1], 1.0f);
}

TEST(Priorities, TheSliderGoesFromSaliencyToTask) {
  const auto frame = fourObjects();
  for (const std::uint32_t salient : {1u, 2u, 3u, 5u}) {
    const ImageGray map = salientOnlyAt(salient, *frame);
    const Importance bySaliency = importanceOf(*frame, map, {.attention = 0});
    EXPECT_EQ(ranking(bySaliency.priority).front(), salient);
    const Importance byTask = importanceOf(*frame, map, {.attention = 1});
    EXPECT_GT(byTask.priority[2], byTask.priority[1]) << "the middle before the corner";
    EXPECT_EQ(byTask.priority, byTask.task);
    const Importance half = importanceOf(*frame, map, {.attention = 0.5f});
    for (const std::size_t id : {1, 2, 3, 5}) {
      EXPECT_FLOAT_EQ(half.priority[id], 0.5f * (half.saliency[id] + half.task[id]));
    }
  }
}

TEST(Priorities, AreInReachForAllThatIsVisibleAndZeroForTheRest) {
  const auto frame = fourObjects();
  const ImageGray nothingStandsOut(kWidth, kHeight, 0.0f);
  for (const Order order : {Order::attention, Order::importance, Order::gain, Order::task, Order::random,
                            Order::scanline, Order::largest}) {
    for (const float weight : {0.0f, 0.5f, 1.0f}) {
      const auto priority =
          importanceOf(*frame, nothingStandsOut, {.order = order, .attention = weight}).priority;
      ASSERT_EQ(priority.size(), 6u);
      EXPECT_EQ(priority[0], 0.0f);
      EXPECT_EQ(priority[4], 0.0f);
      for (const std::size_t id : {1, 2, 3, 5}) {
        EXPECT_GT(priority[id], 0.0f);
        EXPECT_LE(priority[id], 1.0f);
      }
    }
  }
}

TEST(Priorities, OfTheBaselines) {
  const auto frame = fourObjects();
  const auto rank = [&](Order order, std::uint32_t seed = 1) {
    return ranking(importanceOf(*frame, {}, {.order = order, .seed = seed}).priority);
  };
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(rank(Order::scanline), (Ids{1, 3, 2, 5}));
  EXPECT_EQ(rank(Order::largest), (Ids{3, 5, 1, 2}));  // 1 and 2 are of equal size
  EXPECT_EQ(rank(Order::task), (Ids{2, 3, 5, 1}));
  EXPECT_EQ(rank(Order::gain), (Ids{1, 2, 3, 5})) << "all alike: the queue's gains decide";
  EXPECT_EQ(rank(Order::random), rank(Order::random));
  std::set<Ids> seen;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) seen.insert(rank(Order::random, seed));
  EXPECT_GT(seen.size(), 20u) << "of 24 orders of four objects";
}

}  // namespace
}  // namespace saccade::attention
