// Walks along a schedule, their figures, and which methods walk under which budgets.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bench/methods/walkers.h"
#include "bench/moving/matrix.h"
#include "bench/moving/walk_trial.h"
#include "core/image_io.h"
#include "tests/unit/bench/inline_stage.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{96, 64};
const Stretch kStretch{3, 0.25, 2};
constexpr double kBudget = 0.066;

app::CameraPath cornellPath() { return app::CameraPath::read(bundledPath("cornell")); }

WalkResult walkCornell(const Method& method, const Schedule& schedule = Schedule(kStretch, kBudget)) {
  return walkOnce(*method.walk(inlineCornell(), kSize), cornellPath(), schedule);
}

Method methodOf(const std::string& key) {
  for (const Method& method : allMethods()) {
    if (method.key() == key) return method;
  }
  throw std::logic_error("no method " + key);
}

/// The walk's own pictures as truth.
std::vector<Grader> truthsOf(const WalkResult& walk) {
  std::vector<Grader> truths;
  for (const Shot& shot : walk.shots) truths.emplace_back(shot.linear);
  return truths;
}

/// As a record would hold them.
std::map<std::string, double> errorsOf(const WalkResult& walk, const std::vector<Grader>& truths) {
  Record record;
  addErrors(record, {meanGrade(walk, truths)});
  std::map<std::string, double> errors;
  for (const auto& [name, value] : record.values) errors[name] = value.median;
  return errors;
}

TEST(MovingWalk, ShotsAreTheKeyViewsAndTheFramesBeforeThem) {
  const Schedule schedule(kStretch, kBudget);
  const WalkResult walk = walkCornell(methodOf("base"), schedule);
  ASSERT_EQ(walk.shots.size(), 2u);
  const auto fresh = walkBase(inlineCornell(), kSize);
  const auto shown = [&](int frame) {
    fresh->frame(cornellPath().at(schedule.seconds(frame)), std::chrono::seconds(1));
    return fresh->display().pixels();
  };
  for (int k = 0; k < 2; ++k) {
    const Shot& shot = walk.shots[static_cast<std::size_t>(k)];
    EXPECT_EQ(shot.before.pixels(), shown(schedule.frameOf(k) - 1));
    EXPECT_EQ(shot.display.pixels(), shown(schedule.frameOf(k)));
    EXPECT_EQ(shot.display.pixels(), core::toDisplay(shot.linear, 0).pixels());
    EXPECT_NE(shot.before.pixels(), shot.display.pixels()) << "the camera moves";
  }
}

TEST(MovingWalk, TheColdFrameIsNotCounted) {
  const Schedule schedule(kStretch, kBudget);
  const auto walker = methodOf(kMainMethod).walk(inlineCornell(), kSize);
  const WalkResult walk = walkOnce(*walker, cornellPath(), schedule);
  const app::RunStats& all = walker->stats();
  EXPECT_EQ(walk.stats.frameMs.size(), static_cast<std::size_t>(schedule.frames() - 1));
  EXPECT_EQ(walk.stats.samplesPerFrame.size(), walk.stats.frameMs.size());
  EXPECT_GT(walk.stats.samplesTraced, 0u);
  EXPECT_EQ(walk.stats.samplesTraced, all.samplesTraced - all.samplesPerFrame.front());
  EXPECT_LT(walk.stats.rays, all.rays);
}

TEST(MovingWalk, InlineFiguresOfPicturesAreTheSameTwice) {
  const Schedule brief({3, 0.02, 2}, 0.002);  // a budget in which not all can be traced
  const std::vector<Grader> truths = truthsOf(walkCornell(methodOf("raytrace"), brief));
  for (const char* key : {"base", kMainMethod, "corrective-random-nocache"}) {
    SCOPED_TRACE(key);
    const WalkResult a = walkCornell(methodOf(key), brief), b = walkCornell(methodOf(key), brief);
    EXPECT_EQ(errorsOf(a, truths), errorsOf(b, truths));
    EXPECT_EQ(stepOf(a), stepOf(b));
    EXPECT_EQ(a.stats.samplesPerFrame, b.stats.samplesPerFrame);
    EXPECT_EQ(a.stats.rays, b.stats.rays);
    EXPECT_GT(errorsOf(a, truths).at("flip"), 0);
  }
}

TEST(MovingWalk, TruthAgainstItselfHasNoErrorAndAStillCameraNoStep) {
  const WalkResult walk = walkOnce(*walkBase(inlineCornell(), kSize),
                                   app::CameraPath::still(cornellPath().at(3)), Schedule(kStretch, kBudget));
  const Metrics errors = errorsOf(walk, truthsOf(walk));
  for (const char* name : {"flip", "flip_median", "flip_p95", "flip_salient", "relmse", "rmse"})
    EXPECT_EQ(errors.at(name), 0) << name;
  EXPECT_EQ(errors.at("ssim"), 1);
  EXPECT_TRUE(std::isinf(errors.at("psnr")));
  EXPECT_EQ(stepOf(walk), 0);
}

TEST(MovingWalk, ErrorsAreMeansOverKeyViews) {
  const WalkResult base = walkCornell(methodOf("base"));
  const std::vector<Grader> truths = truthsOf(walkCornell(methodOf("raytrace")));
  const Grade first = truths[0].grade(base.shots[0].linear), second = truths[1].grade(base.shots[1].linear);
  const auto mean = errorsOf(base, truths);
  EXPECT_NE(first.errors.flip, second.errors.flip);
  EXPECT_DOUBLE_EQ(mean.at("flip"), (first.errors.flip + second.errors.flip) / 2);
  EXPECT_DOUBLE_EQ(mean.at("flip_salient"), (first.flipSalient + second.flipSalient) / 2);
  EXPECT_DOUBLE_EQ(mean.at("ssim"), (first.errors.ssim + second.errors.ssim) / 2);
  EXPECT_DOUBLE_EQ(mean.at("max_abs"), (first.errors.maxAbs + second.errors.maxAbs) / 2);
}

TEST(MovingWalk, SpeedsByHand) {
  WalkResult walk;
  walk.stats.frameMs = {10, 20, 30, 40};
  walk.stats.samplesPerFrame = {100, 300, 200, 400};
  walk.stats.samplesTraced = 1000;
  walk.stats.samplesReused = 80;
  walk.stats.rays = 5000;
  walk.stats.missedDeadlines = 1;
  const Metrics speed = speedOf(walk);
  EXPECT_EQ(speed.at("frame_p50"), 20);
  EXPECT_EQ(speed.at("frame_p95"), 40);
  EXPECT_EQ(speed.at("missed_share"), 0.25);
  EXPECT_DOUBLE_EQ(speed.at("samples_per_second"), 10000);
  EXPECT_DOUBLE_EQ(speed.at("rays_per_second"), 50000);
  EXPECT_EQ(speed.at("samples_per_frame"), 200);
  EXPECT_EQ(speed.at("reused_per_frame"), 20);
}

TEST(MovingWalk, ValuesKnowWhatTheyAre) {
  EXPECT_EQ(speedValue("frame_p95", {1}).unit, "ms");
  EXPECT_EQ(speedValue("rays_per_second", {1}).kind, Kind::rate);
  EXPECT_EQ(speedValue("samples_per_frame", {1}).unit, "1/frame");
  EXPECT_EQ(speedValue("missed_share_8ms", {1}).better, Better::lower);
}

std::set<std::string> keysOf(const std::vector<Method>& methods) {
  std::set<std::string> keys;
  for (const Method& method : methods) keys.insert(method.key());
  return keys;
}

TEST(MovingMatrix, QuickHasTheMainVariantsThePaperTheOrdersAtTwoBudgetsAndFullEverything) {
  const std::set<std::string> main = {"base", "corrective-attention", "corrective-attention-nocache"};
  BenchOptions options;
  EXPECT_EQ(movingBudgets(Suite::quick), (std::vector<double>{16, 66}));
  EXPECT_EQ(keysOf(movingMethods(options, 66)), main);
  EXPECT_TRUE(unbudgetedMethods(options).empty());

  options.suite = Suite::paper;
  EXPECT_EQ(movingBudgets(Suite::paper), (std::vector<double>{8, 16, 33, 66, 125}));
  EXPECT_EQ(keysOf(movingMethods(options, 66)), main);
  std::set<std::string> orders = main;
  orders.insert({"corrective-random", "corrective-scanline", "corrective-largest", "corrective-task",
                 "corrective-attention0", "corrective-attention1"});
  EXPECT_EQ(keysOf(movingMethods(options, 16)), orders);
  EXPECT_EQ(keysOf(unbudgetedMethods(options)), (std::set<std::string>{"path", "raytrace"}));

  options.suite = Suite::full;
  EXPECT_EQ(movingMethods(options, 33).size(), 15u);  // base; two caches, three weights and four other orders
}

TEST(MovingMatrix, MethodsAreLeftOutOnRequest) {
  BenchOptions options;
  options.suite = Suite::paper;
  options.methods = {"base", "path"};
  EXPECT_EQ(keysOf(movingMethods(options, 16)), std::set<std::string>{"base"});
  EXPECT_EQ(keysOf(unbudgetedMethods(options)), std::set<std::string>{"path"});
}

}  // namespace
}  // namespace saccade::bench
