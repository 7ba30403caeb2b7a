// The methods on still views, inline and therefore exact.
#include "bench/methods/stills.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "bench/reference/grade.h"
#include "bench/still/still.h"
#include "core/error.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::bench {
namespace {

using attention::AttentionOptions;

/// The room with small maps; every stage of the frame loop inline.
Stage& cornell() {
  static const auto stage = [] {
    const tests::TemporaryFolder folder;
    app::SceneOptions scene;
    scene.path = SACCADE_SOURCE_DIR "/data/scenes/cornell.glb";
    scene.quality = "preview";
    scene.photons = 20000;
    auto made = std::make_unique<Stage>();
    made->name = "cornell";
    made->workspace = app::openWorkspace(scene, {.file = folder / "cornell.maps", .threads = 2}, {});
    made->gl = std::make_unique<app::Headless>(app::RunOptions{}, *made->workspace);
    made->tracers = 0;
    return made;
  }();
  return *stage;
}

StillTask task(double longestSeconds) {
  return {app::chooseCamera(cornell().workspace->scene, {}), {48, 40}, longestSeconds, {}};
}

template <class Still>
std::vector<Point> pointsOf(Still still) {
  std::vector<Point> points;
  still([&](Point point) { points.push_back(std::move(point)); });
  return points;
}

TEST(Stills, ConvergedIsRayTraced) {
  const auto corrective = pointsOf(
      [](const TakePoint& take) { stillCorrective(cornell(), task(1e6), take, AttentionOptions{}, true); });
  const auto raytrace = pointsOf([](const TakePoint& take) { stillRaytrace(cornell(), task(1e6), take); });
  ASSERT_EQ(raytrace.size(), 4u);
  ASSERT_GT(corrective.size(), raytrace.size()) << "budgets first";
  for (std::size_t i = 0; i < raytrace.size(); ++i) {
    const Point& converged = corrective[corrective.size() - raytrace.size() + i];
    EXPECT_EQ(converged.subSamples, raytrace[i].subSamples);
    EXPECT_EQ(converged.linear.pixels(), raytrace[i].linear.pixels()) << converged.setting;
    EXPECT_EQ(converged.samples, raytrace[i].samples);
    EXPECT_EQ(converged.rays, raytrace[i].rays);
  }
}

TEST(Stills, BudgetsEndWhereThePictureHasConverged) {
  AttentionOptions scanline;
  scanline.order = attention::Order::scanline;
  const auto points =
      pointsOf([&](const TakePoint& take) { stillCorrective(cornell(), task(1e6), take, scanline, false); });
  const auto raytrace = pointsOf([](const TakePoint& take) { stillRaytrace(cornell(), task(0), take); });
  ASSERT_GE(points.size(), 1u);
  EXPECT_EQ(points.back().linear.pixels(), raytrace.front().linear.pixels());
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GT(points[i].budgetMs, points[i - 1].budgetMs);
    EXPECT_GE(points[i].samples, points[i - 1].samples);
  }
}

TEST(Stills, FewestSamplesOfAThreshold) {
  for (const std::uint64_t threshold : {101, 150, 163, 200}) {
    const std::uint64_t found =
        fewestSamples(100, 200, [&](std::uint64_t samples) { return samples >= threshold; });
    EXPECT_GE(found, threshold);
    EXPECT_LE(found, threshold + 100 / 32 + 1);
  }
  EXPECT_EQ(fewestSamples(0, 1, [](std::uint64_t) { return false; }), 1u);
}

// The point of the paper's section 3: rough corrections everywhere soon. Since the queue covers every object
// before it refines any, that holds in whatever order objects come. Counts, not times.
TEST(Stills, HalfTheErrorIsGoneAfterAFractionOfTheSamplesInAnyOrder) {
  const auto all = stillAfterSamples(cornell(), task(0), AttentionOptions{}, 48 * 40);
  const Grader converged(all.linear);
  const double half = converged.grade(stillAfterSamples(cornell(), task(0), {}, 0).linear).flipSalient / 2;
  for (const attention::Order order :
       {attention::Order::attention, attention::Order::random, attention::Order::scanline}) {
    AttentionOptions attention;
    attention.order = order;
    const std::uint64_t samples = fewestSamples(0, all.samples, [&](std::uint64_t n) {
      return converged.grade(stillAfterSamples(cornell(), task(0), attention, n).linear).flipSalient <= half;
    });
    EXPECT_LT(4 * samples, all.samples) << static_cast<int>(order);
  }
}

TEST(Stills, SampleBudgetsGiveTheSamePictureOnAnyNumberOfThreads) {
  const Point inlined = stillAfterSamples(cornell(), task(0), AttentionOptions{}, 100);
  EXPECT_EQ(inlined.samples, 100u);
  cornell().tracers = 2;
  EXPECT_EQ(stillAfterSamples(cornell(), task(0), AttentionOptions{}, 100).linear.pixels(),
            inlined.linear.pixels());
  cornell().tracers = 0;
}

TEST(Stills, TheLongestPointIsTheLast) {
  EXPECT_EQ(pointsOf([](const TakePoint& take) { stillPath(cornell(), task(0), take); }).size(), 1u);
  EXPECT_EQ(pointsOf([](const TakePoint& take) { stillRaytrace(cornell(), task(0), take); }).size(), 1u);
  EXPECT_EQ(pointsOf([](const TakePoint& take) { stillBase(cornell(), task(1e6), take); }).size(), 1u);
}

TEST(Stills, AStopIsAnError) {
  std::stop_source stopped;
  stopped.request_stop();
  StillTask t = task(1e6);
  t.stop = stopped.get_token();
  const TakePoint none = [](const Point&) { ADD_FAILURE() << "a picture that was stopped"; };
  EXPECT_THROW(stillCorrective(cornell(), t, none, AttentionOptions{}, true), core::Error);
  EXPECT_THROW(stillRaytrace(cornell(), t, none), core::Error);
  EXPECT_THROW(stillPath(cornell(), t, none), core::Error);
}

TEST(Methods, HaveKeysOfTheirOwnAndWhatTheySay) {
  std::set<std::string> keys;
  int corrective = 0;
  for (const Method& method : allMethods()) {
    EXPECT_TRUE(keys.insert(method.key()).second) << method.key();
    EXPECT_EQ(method.labels.at("method"), method.name);
    if (method.name != "corrective") {
      EXPECT_TRUE(method.still) << method.key();
      continue;
    }
    ++corrective;
    EXPECT_EQ(static_cast<bool>(method.still), method.labels.at("cache") == "on") << method.key();
  }
  EXPECT_EQ(corrective, 14) << "seven orders and weights, with and without cache";
  EXPECT_EQ(keys.count("corrective-attention"), 1u);
}

TEST(Grader, NothingDiffersFromItself) {
  core::ImageRgb picture(40, 30, core::Vec3(0.2f));
  picture.at(12, 20) = core::Vec3(0.9f, 0.5f, 0.1f);
  const Grader grader(picture);
  const Grade same = grader.grade(picture);
  EXPECT_EQ(same.errors.relmse, 0);
  EXPECT_EQ(same.flipSalient, 0);
}

TEST(Grader, ErrorsAtTheSalientPlaceCountMore) {
  core::ImageRgb picture(64, 48, core::Vec3(0.2f));
  for (int y = 10; y < 14; ++y) {
    for (int x = 10; x < 14; ++x) picture.at(x, y) = core::Vec3(0.8f);
  }
  const Grader grader(picture);
  core::ImageRgb there = picture, elsewhere = picture;
  there.at(12, 12) += core::Vec3(-0.2f);
  elsewhere.at(52, 36) += core::Vec3(0.2f);
  const Grade a = grader.grade(there), b = grader.grade(elsewhere);
  EXPECT_GT(a.flipSalient, a.errors.flip);
  EXPECT_LT(b.flipSalient, b.errors.flip);
  Record record;
  addErrors(record, {a, b});
  EXPECT_EQ(record.values.at("flip").repeats, 2);
  EXPECT_EQ(record.values.at("psnr").better, Better::higher);
  EXPECT_EQ(record.values.size(), 9u);
}

}  // namespace
}  // namespace saccade::bench
