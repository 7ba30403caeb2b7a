// The curve of error against seconds while the camera rests: how it ends, what it keeps, and when it stops.
#include "app/session/live_error.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>

#include "core/error.h"
#include "core/metrics/comparison.h"
#include "tests/unit/app/fixtures.h"
#include "tests/unit/core/mask_frame.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using app::LiveError;
using app::RestingPicture;

constexpr double kLong = 2 * LiveError::kRestSeconds;

/// Waits for the background thread. The bound is that of a test that would otherwise hang.
template <class Condition>
void waitFor(Condition&& condition) {
  const auto giveUp = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!condition()) {
    ASSERT_LT(std::chrono::steady_clock::now(), giveUp) << "the background thread does not get there";
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// An 8 x 8 frame of one object; its corrections are all 1 in the reference.
class LiveErrorTest : public testing::Test {
 protected:
  static constexpr int kSide = 8;
  static constexpr std::size_t kPixels = kSide * kSide;

  core::FramePtr frame_ = tests::frameOf(kSide, kSide, std::vector<std::uint32_t>(kPixels, 1), 1);
  std::atomic<int> traced_{0};

  static std::vector<core::Vec4> corrections(float value) {
    return std::vector<core::Vec4>(kPixels, core::Vec4(value, value, value, 0));
  }
  LiveError::Trace counted() {
    return [this](const core::FrameSnapshot&, const core::Progress& progress) {
      ++traced_;
      progress.report(0.5);
      return corrections(1);
    };
  }
  /// Ends only when it is told to.
  LiveError::Trace endless() {
    return [this](const core::FrameSnapshot&, const core::Progress& progress) -> std::vector<core::Vec4> {
      ++traced_;
      while (!progress.stop.stop_requested()) std::this_thread::yield();
      throw core::Error("stopped");
    };
  }
  void observe(LiveError& live, double seconds, float value, bool converged = false, float ev = 0) const {
    const std::vector<core::Vec4> shown = corrections(value);
    live.observe({frame_, shown, seconds, converged, ev});
  }
};

TEST_F(LiveErrorTest, NothingIsTracedBeforeTheCameraHasRested) {
  {
    LiveError live(counted());
    EXPECT_FALSE(live.state().resting);
    for (int i = 1; i < 10; ++i) observe(live, LiveError::kRestSeconds * i / 10, 0);
    EXPECT_TRUE(live.state().resting);
    live.reset();  // hidden, or the camera moved
    EXPECT_FALSE(live.state().resting);
  }
  EXPECT_EQ(traced_, 0);
}

TEST_F(LiveErrorTest, TheCurveHasItsBeginningAndEndsAtExactlyZero) {
  LiveError live(counted());
  for (int i = 1; i <= 10; ++i) observe(live, 0.1 * i, 0.1f * static_cast<float>(i), i == 10);
  waitFor([&] { return live.state().complete; });
  const LiveError::State state = live.state();
  EXPECT_EQ(state.referenceDone, 1);
  ASSERT_EQ(state.points.size(), 10u);
  EXPECT_EQ(state.points.front().seconds, 0.1);
  const double left = 1 - 0.1f;  // the base is black
  EXPECT_FLOAT_EQ(static_cast<float>(state.points.front().relmse),
                  static_cast<float>(left * left / (1 + core::kRelativeEpsilon)));
  for (std::size_t i = 1; i < state.points.size(); ++i) {
    EXPECT_GT(state.points[i].seconds, state.points[i - 1].seconds);
    EXPECT_LT(state.points[i].relmse, state.points[i - 1].relmse);
    EXPECT_LT(state.points[i].flip, state.points[i - 1].flip);
  }
  EXPECT_EQ(state.points.back().relmse, 0);
  EXPECT_EQ(state.points.back().flip, 0);
  observe(live, 9, 1, true);
  EXPECT_EQ(live.state().points.size(), 10u) << "nothing follows the converged picture";
  EXPECT_EQ(traced_, 1);
}

TEST_F(LiveErrorTest, PicturesAfterTheReferenceAreMeasuredAsTheyCome) {
  LiveError live(counted());
  observe(live, kLong, 0);
  waitFor([&] { return live.state().points.size() == 1; });
  observe(live, 2 * kLong, 0.5f);
  waitFor([&] { return live.state().points.size() == 2; });
  EXPECT_FALSE(live.state().complete);
  EXPECT_LT(live.state().points[1].relmse, live.state().points[0].relmse);
  EXPECT_EQ(traced_, 1);
}

TEST_F(LiveErrorTest, ALongRestIsThinnedEvenlyOnALogarithmicAxis) {
  LiveError live(counted());
  for (int i = 1; i <= 20000; ++i) observe(live, 0.04 * i, 0, i == 20000);
  waitFor([&] { return live.state().complete; });
  const std::vector<app::ErrorPoint> points = live.state().points;
  EXPECT_LE(points.size(), LiveError::kMaxPictures);
  EXPECT_GE(points.size(), LiveError::kMaxPictures / 2);
  EXPECT_EQ(points.front().seconds, 0.04);
  EXPECT_EQ(points.back().seconds, 0.04 * 20000);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    EXPECT_GE(points[i].seconds, points[i - 1].seconds * app::LogSeries<int>::kFirstStep);
  }
}

TEST_F(LiveErrorTest, AnotherExposureMeasuresFlipAgain) {
  LiveError live(counted());
  observe(live, 0.1, 0.5f);
  observe(live, kLong, 1, true);
  waitFor([&] { return live.state().complete; });
  const std::vector<app::ErrorPoint> before = live.state().points;
  observe(live, 2 * kLong, 1, true, 4);  // both pictures are white now
  waitFor([&] { return live.state().complete; });
  const std::vector<app::ErrorPoint> after = live.state().points;
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after[0].relmse, before[0].relmse);
  EXPECT_GT(before[0].flip, 0);
  EXPECT_EQ(after[0].flip, 0);
  EXPECT_EQ(traced_, 1);
}

TEST_F(LiveErrorTest, MovingCancelsAndTheNextRestBeginsAnew) {
  LiveError live(endless());
  observe(live, kLong, 0);
  waitFor([&] { return traced_ == 1; });
  live.reset();
  EXPECT_FALSE(live.state().resting);
  EXPECT_TRUE(live.state().points.empty());
  frame_ = tests::frameOf(kSide, kSide, std::vector<std::uint32_t>(kPixels, 1), 1, 10, 2);
  observe(live, kLong, 0);
  waitFor([&] { return traced_ == 2; });  // the first one ended, else this one could not begin
  EXPECT_TRUE(live.state().failure.empty()) << live.state().failure;
  frame_ = tests::frameOf(kSide, kSide, std::vector<std::uint32_t>(kPixels, 1), 1, 10, 3);
  observe(live, kLong, 0);  // without a reset between
  waitFor([&] { return traced_ == 3; });
}  // the destructor ends the third

TEST_F(LiveErrorTest, AFailureIsSaidAndGoesWithTheRest) {
  LiveError live([](const core::FrameSnapshot&, const core::Progress&) -> std::vector<core::Vec4> {
    throw core::Error("no rays today");
  });
  observe(live, kLong, 0);
  waitFor([&] { return !live.state().failure.empty(); });
  EXPECT_EQ(live.state().failure, "no rays today");
  live.reset();
  EXPECT_TRUE(live.state().failure.empty());
}

/// Samples whose splats cover more than their own pixel.
std::uint64_t coarseSamples(const FrameLoop& loop) {
  const auto& levels = loop.stats().levels;
  return std::accumulate(levels.begin(), levels.end() - 1, std::uint64_t{0});
}

// A coarse splat may spread a lamp's reflection over its whole square, so the curve may rise at first; a
// sample of the finest level replaces its own pixel by the exact one, so from there on it only falls.
TEST(LiveErrorOfALoop, FallsToExactlyZeroOnceEveryLevelIsCovered) {
  const app::Workspace& workspace = tests::workspaceOf(tests::bundled("cornell.glb"));
  app::Headless gl(tests::runOn("osmesa"), workspace);
  FrameLoop loop(workspace, *gl.renderer, {.threads = 0});
  const core::Camera& camera = workspace.scene.cameras[0];
  const app::ImageSize size{96, 64};
  LiveError live(app::tracedBy(loop.tracer()));
  std::vector<std::uint64_t> coarse;
  for (double seconds = 0.2; !loop.converged(); seconds *= 1.11) {
    loop.step(camera, size, FrameBudget::firstSamples(150));
    live.observe({loop.layer().frame(), loop.corrections(), seconds, loop.converged(), 0});
    coarse.push_back(coarseSamples(loop));
    ASSERT_TRUE(loop.rests(camera, size));
  }
  waitFor([&] { return live.state().complete; });
  const std::vector<app::ErrorPoint> points = live.state().points;
  ASSERT_EQ(points.size(), coarse.size());
  int falls = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (coarse[i] != coarse[i - 1]) continue;
    EXPECT_LE(points[i].relmse, points[i - 1].relmse) << "point " << i;
    ++falls;
  }
  EXPECT_GE(falls, 3);
  EXPECT_GT(points.front().relmse, 0);
  EXPECT_EQ(points.back().relmse, 0);
  EXPECT_EQ(points.back().flip, 0);
}

TEST(LogSeries, KeepsTheFirstItemAndItsBound) {
  app::LogSeries<int> series(8);
  int offered = 0;
  for (double t = 0.01; t < 1000; t += 0.01) {
    if (!series.wants(t)) continue;
    series.add(t, offered++);
    ASSERT_LE(series.entries().size(), 8u);
    ASSERT_EQ(series.entries().front().item, 0);
  }
  EXPECT_GE(series.entries().size(), 4u);
  EXPECT_GT(series.step(), app::LogSeries<int>::kFirstStep);
}

}  // namespace
}  // namespace saccade
