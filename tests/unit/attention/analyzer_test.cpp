#include "attention/analyzer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "core/error.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

using core::AnalysisInput;
using core::RegionQueue;
using core::SnapshotMailbox;
using tests::rgb;

constexpr int kSide = 128;

// Object 1 in a corner, object 2 in the middle; the picture is bright at object `salient`.
AnalysisInput twoObjects(std::uint64_t epoch, std::uint32_t salient = 1) {
  auto display = std::make_shared<core::ImageRgba8>(kSide, kSide, rgb(30, 30, 30));
  tests::paint(*display, salient == 1 ? tests::Disc{12, 12, 10} : tests::Disc{64, 64, 10},
               rgb(230, 230, 230));
  return {tests::makeFrame(kSide, kSide, {{1, {2, 2, 22, 22}}, {2, {54, 54, 74, 74}}}, 2, epoch), display};
}

// Waits for another thread; fails after a time that no working program needs.
bool eventually(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

TEST(Analyzer, InlineGivesPrioritiesAndKeepsWhatItSaw) {
  Analyzer analyzer({.attention = 0});
  EXPECT_EQ(analyzer.latest(), nullptr);
  for (const std::uint32_t salient : {1u, 2u}) {
    const AnalysisInput input = twoObjects(10 + salient, salient);
    const std::vector<float> priority = analyzer.analyzeNow(input);
    ASSERT_EQ(priority.size(), 3u);
    EXPECT_GT(priority[salient], priority[3 - salient]);
    const auto seen = analyzer.latest();
    EXPECT_EQ(seen->epoch, 10 + salient);
    EXPECT_EQ(seen->importance.priority, priority);
    EXPECT_EQ(seen->saliency.pixels(), saliencyOf(*input.display, {}).pixels());
    EXPECT_EQ(analyzer.times().analyses, salient);
  }
  EXPECT_GT(analyzer.times().totalMilliseconds, 0);
}

TEST(Analyzer, TheSliderCountsFromTheNextAnalysis) {
  Analyzer analyzer({.attention = 0});
  const AnalysisInput cornerIsSalient = twoObjects(1, 1);
  const std::vector<float> bySaliency = analyzer.analyzeNow(cornerIsSalient);
  EXPECT_GT(bySaliency[1], bySaliency[2]);
  analyzer.setAttention(1);
  const std::vector<float> byTask = analyzer.analyzeNow(cornerIsSalient);
  EXPECT_LT(byTask[1], byTask[2]);
  analyzer.setAttention(7);
  EXPECT_EQ(analyzer.attention(), 1);
  analyzer.setAttention(-7);
  EXPECT_EQ(analyzer.attention(), 0);
  analyzer.setAttention(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(analyzer.attention(), 0);
}

TEST(Analyzer, WhatIsAttendedToComesFirstWhateverTheOrderAndDecays) {
  for (const Order order : {Order::attention, Order::importance, Order::gain, Order::task, Order::random,
                            Order::scanline, Order::largest}) {
    double seconds = 100;
    Analyzer analyzer({.order = order}, [&seconds] { return seconds; });
    const AnalysisInput input = twoObjects(1);
    const std::vector<float> before = analyzer.analyzeNow(input);
    EXPECT_TRUE(analyzer.latest()->importance.attended.empty());
    for (const std::uint32_t id : {1u, 2u}) {
      analyzer.attend(id);
      const std::vector<float> risen = analyzer.analyzeNow(input);
      EXPECT_GT(risen[id], risen[3 - id]);
      EXPECT_FLOAT_EQ(risen[id], before[id] + AttendedObjects::kHeight);
      EXPECT_EQ(analyzer.latest()->importance.priority, risen);
      EXPECT_EQ(analyzer.latest()->importance.attended[id], AttendedObjects::kHeight);
      seconds += AttendedObjects::kHalfLifeSeconds;
      EXPECT_FLOAT_EQ(analyzer.analyzeNow(input)[id], before[id] + AttendedObjects::kHeight / 2);
      seconds += 1000;
      EXPECT_EQ(analyzer.analyzeNow(input), before);
    }
  }
}

TEST(Analyzer, AttendingToWhatIsNotThereIsHarmless) {
  Analyzer analyzer({.attention = 0}, [] { return 0.0; });
  const AnalysisInput input = twoObjects(1);
  const std::vector<float> before = analyzer.analyzeNow(input);
  for (const std::uint32_t id : {0u, 3u, std::numeric_limits<std::uint32_t>::max()}) analyzer.attend(id);
  EXPECT_EQ(analyzer.analyzeNow(input), before);
  AnalysisInput outOfSight = input;
  outOfSight.frame = tests::makeFrame(kSide, kSide, {{1, {2, 2, 22, 22}}}, 2);
  analyzer.attend(2);
  EXPECT_EQ(analyzer.analyzeNow(outOfSight)[2], 0.0f);
  EXPECT_GT(analyzer.analyzeNow(input)[2], 1.0f) << "it comes into sight while it is attended to";
}

TEST(Analyzer, OtherOrdersLookAtNoPicture) {
  Analyzer analyzer({.order = Order::largest});
  AnalysisInput input = twoObjects(1);
  input.display = nullptr;
  EXPECT_EQ(analyzer.analyzeNow(input).size(), 3u);
  EXPECT_TRUE(analyzer.latest()->saliency.empty());
}

TEST(Analyzer, TheThreadOrdersTheQueue) {
  SnapshotMailbox mailbox;
  RegionQueue queue(64);
  const AnalysisInput input = twoObjects(1, 2);
  queue.beginFrame(input.frame);
  EXPECT_EQ(queue.tryPop()->id, 1u) << "before any analysis ties go to the smaller id";
  queue.beginFrame(input.frame);
  Analyzer analyzer({.attention = 0});
  analyzer.start(mailbox, queue);
  mailbox.put(input);
  ASSERT_TRUE(eventually([&] { return analyzer.latest() && mailbox.wanted(); }));
  EXPECT_EQ(queue.tryPop()->id, 2u);
  analyzer.stop();
  EXPECT_NO_THROW(analyzer.check());
}

TEST(Analyzer, TheThreadEndsUpAtTheLatestFrame) {
  SnapshotMailbox mailbox;
  RegionQueue queue(64);
  Analyzer analyzer({});
  analyzer.start(mailbox, queue);
  constexpr std::uint64_t kFrames = 50;
  for (std::uint64_t epoch = 1; epoch <= kFrames; ++epoch) mailbox.put(twoObjects(epoch));
  EXPECT_TRUE(eventually([&] { return analyzer.latest() && analyzer.latest()->epoch == kFrames; }));
  EXPECT_LE(analyzer.times().analyses, kFrames);
}

TEST(Analyzer, StopsWhileItWaitsAndWhileItWorks) {
  for (const bool busy : {false, true}) {
    SnapshotMailbox mailbox;
    RegionQueue queue(64);
    Analyzer analyzer({});
    analyzer.start(mailbox, queue);
    ASSERT_TRUE(eventually([&] { return mailbox.wanted(); }));
    if (busy) mailbox.put(twoObjects(1));
    analyzer.stop();
    analyzer.stop();
    EXPECT_FALSE(mailbox.take().has_value()) << "stopping closes the mailbox";
  }
}

TEST(Analyzer, EndsWhenTheMailboxIsClosedByOthers) {
  SnapshotMailbox mailbox;
  RegionQueue queue(64);
  Analyzer analyzer({});
  analyzer.start(mailbox, queue);
  mailbox.close();
  analyzer.stop();
  EXPECT_NO_THROW(analyzer.check());
  EXPECT_NO_THROW(analyzer.analyzeNow(twoObjects(3)));
}

TEST(Analyzer, CheckRethrowsWhatEndedTheThread) {
  SnapshotMailbox mailbox;
  RegionQueue queue(64);
  Analyzer analyzer({});
  analyzer.start(mailbox, queue);
  AnalysisInput misfit = twoObjects(1);
  misfit.display = std::make_shared<core::ImageRgba8>(kSide, kSide / 2);
  mailbox.put(misfit);
  EXPECT_TRUE(eventually([&] {
    try {
      analyzer.check();
      return false;
    } catch (const core::Error&) {
      return true;
    }
  }));
  analyzer.stop();
  EXPECT_THROW(analyzer.check(), core::Error);
}

}  // namespace
}  // namespace saccade::attention
