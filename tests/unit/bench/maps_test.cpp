// Illumination maps against their reference: the error's formula, references that are kept and refused, and
// the gather that maps are compared with.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>

#include "bench/maps/gathered_maps.h"
#include "bench/maps/map_error.h"
#include "bench/maps/point_reference.h"
#include "bench/maps/soonness.h"
#include "bench/maps/worst_points.h"
#include "bench/reference/kept_sums.h"
#include "raytrace/bake/charts.h"
#include "tests/command_line.h"
#include "tests/unit/core/own_cache_folder.h"

namespace saccade::bench {
namespace {

using core::Vec3;

TEST(MapError, HandComputed) {
  // Luminances 2 and 4 (mean 3), off by +1 and -1; the reference's own variance of 1 and 0 is taken out.
  const std::vector<PointTruth> truth = {{Vec3(2), 1}, {Vec3(4), 0}};
  const std::vector<Vec3> found = {Vec3(3), Vec3(3)};
  const MapError error = errorOf(found, truth);
  EXPECT_NEAR(error.relative, std::sqrt(1 - 0.5) / 3, 1e-7);
  EXPECT_NEAR(error.bias, 0, 1e-7);
  EXPECT_NEAR(error.p99, 1.0 / 3, 1e-7);
  EXPECT_NEAR(noiseOf(truth), std::sqrt(0.5) / 3, 1e-7);
}

TEST(MapError, NoiseAloneIsNoError) {
  const std::vector<PointTruth> truth = {{Vec3(2), 1.5}, {Vec3(4), 1}};
  const MapError error = errorOf(std::vector<Vec3>{Vec3(3), Vec3(5)}, truth);
  EXPECT_EQ(error.relative, 0) << "the difference is less than the reference's variance";
  EXPECT_NEAR(error.bias, 1.0 / 3, 1e-7);
}

TEST(MapError, PointsThatNoLightReachesAreCountedAndLeftOut) {
  const std::vector<PointTruth> truth = {{Vec3(2), 0}, {Vec3(0), 0}, {Vec3(4), 0}, {Vec3(0), 0}};
  const MapError error = errorOf(std::vector<Vec3>{Vec3(2), Vec3(1), Vec3(4), Vec3(0)}, truth);
  EXPECT_EQ(error.lit, 2u);
  EXPECT_EQ(error.dark, 2u);
  EXPECT_EQ(error.relative, 0);
  EXPECT_EQ(error.bias, 0);
  EXPECT_NEAR(error.withDark, std::sqrt(0.25) / 1.5, 1e-7) << "over all four";
}

TEST(MapError, IsZeroWhereThereIsNoLight) {
  const MapError error = errorOf(std::vector<Vec3>{Vec3(1)}, std::vector<PointTruth>{{Vec3(0), 0}});
  EXPECT_EQ(error.relative, 0);
  EXPECT_EQ(error.dark, 1u);
  EXPECT_EQ(errorOf({}, {}).lit, 0u);
}

TEST(Soonness, IsExactForErrorsThatFallByAPowerOfTheTime) {
  // Ours falls as 1 / t, the gather as 1 / sqrt(t): at 0.05 they need 4 and 64 seconds.
  const std::vector<CurvePoint> ours = {{1, 0.2}, {16, 0.0125}}, gather = {{1, 0.4}, {100, 0.04}};
  const Record record = soonness(ours, gather, 0.05);
  EXPECT_NEAR(record.values.at("seconds_ours").median, 4, 1e-9);
  EXPECT_NEAR(record.values.at("seconds_gather").median, 64, 1e-9);
  EXPECT_NEAR(record.values.at("time_over_gather").median, 1.0 / 16, 1e-12);
  EXPECT_EQ(record.at.at("relerr"), 0.05);
  EXPECT_EQ(record.labels.count("status"), 0u);
}

TEST(Soonness, IsABoundWhereTheGatherStopsEarlyAndNothingWhereOursDoesNotGetThere) {
  const std::vector<CurvePoint> ours = {{1, 0.2}, {16, 0.0125}}, gather = {{1, 0.4}, {25, 0.08}};
  const Record bound = soonness(ours, gather, 0.05);
  EXPECT_EQ(bound.values.at("seconds_gather").median, 25);
  EXPECT_NEAR(bound.values.at("time_over_gather").median, 4.0 / 25, 1e-12);
  EXPECT_EQ(bound.labels.at("status").rfind("at most", 0), 0u);
  const Record none = soonness(ours, gather, 0.001);
  EXPECT_TRUE(none.values.empty());
  EXPECT_EQ(none.labels.at("status"), "not reached");
}

/// The Cornell room with charts in a small atlas, and maps of nothing but their size.
std::unique_ptr<app::Workspace> charted(int atlasSize) {
  auto w = std::make_unique<app::Workspace>();
  w->scene = core::loadScene(SACCADE_SOURCE_DIR "/data/scenes/cornell.glb", {});
  w->plan = core::makePlan(w->scene);
  w->plan.lightmapSize = atlasSize;
  const raytrace::ChartAtlas atlas = raytrace::makeCharts(w->scene, w->plan, atlasSize);
  core::applyCharts(w->scene, atlas.charts);
  w->world = std::make_unique<raytrace::World>(w->scene, w->plan);
  w->maps.width = w->maps.height = atlas.size;
  w->maps.layers = w->plan.doubleSided ? 2 : 1;
  return w;
}

class PointReferences : public ::testing::Test {
 protected:
  static const app::Workspace& cornell() {
    static const auto workspace = [] {
      app::SceneOptions options;
      options.path = SACCADE_SOURCE_DIR "/data/scenes/cornell.glb";
      return app::openWithoutMaps(options);
    }();
    return *workspace;
  }
  static PointTask task() { return {.points = 24}; }
  PointReference compute(const PointConfidence& confidence, int threads = 2) {
    return computePointReference(cornell(), task(), confidence, threads, {}, warnings_);
  }
  static std::filesystem::path file() { return referenceFile(pointReferenceKey(cornell().scene, task())); }
  static PointConfidence passable() { return {.noise = 10, .capSeconds = 1e6}; }

  static void expectSame(const PointReference& a, const PointReference& b) {
    EXPECT_EQ(a.samplesPerPoint, b.samplesPerPoint);
    ASSERT_EQ(a.truth.size(), b.truth.size());
    for (std::size_t i = 0; i < a.truth.size(); ++i) {
      EXPECT_EQ(a.truth[i].irradiance, b.truth[i].irradiance);
      EXPECT_EQ(a.truth[i].variance, b.truth[i].variance);
    }
  }

  tests::OwnCacheFolder cache_;
  core::Warnings warnings_;
};

TEST_F(PointReferences, KeysDifferWithAllThatTheNumbersDependOn) {
  const std::uint64_t key = pointReferenceKey(cornell().scene, task());
  EXPECT_EQ(pointReferenceKey(cornell().scene, task()), key);
  std::set<std::uint64_t> keys{key};
  EXPECT_TRUE(keys.insert(pointReferenceKey(cornell().scene, {.points = 25})).second);
  EXPECT_TRUE(keys.insert(pointReferenceKey(cornell().scene, {.points = 24, .bounces = 9})).second);
  EXPECT_TRUE(keys.insert(pointReferenceKey(cornell().scene, {.points = 24, .seed = 2})).second);
  core::Scene dimmed = cornell().scene;
  dimmed.materials[0].baseColor.x *= 0.5f;
  EXPECT_TRUE(keys.insert(pointReferenceKey(dimmed, task())).second);
  app::SceneOptions larger;
  larger.path = SACCADE_SOURCE_DIR "/data/scenes/cornell.glb";
  larger.load.unitScale = 2;
  EXPECT_TRUE(keys.insert(pointReferenceKey(app::openWithoutMaps(larger)->scene, task())).second);
}

TEST_F(PointReferences, AreComputedOnceAndKept) {
  const PointReference first = compute(passable());
  EXPECT_TRUE(first.reached);
  EXPECT_GT(first.noise, 0);
  const PointReference again = compute(passable(), 0);
  expectSame(first, again);
  EXPECT_EQ(again.seconds, first.seconds) << "nothing was computed";
  EXPECT_EQ(again.noise, first.noise);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(PointReferences, GoOnAsIfTheyHadNotBeenStopped) {
  const PointConfidence finer{.noise = compute(passable()).noise / 2, .capSeconds = 1e6};
  std::stop_source source;
  int seen = 0;
  const core::Progress progress{[&](double) {
                                  if (++seen == 3) source.request_stop();
                                },
                                source.get_token()};
  EXPECT_THROW(computePointReference(cornell(), task(), finer, 1, progress, warnings_), core::Error);
  const PointReference resumed = compute(finer);
  EXPECT_LE(resumed.noise, finer.noise);
  std::filesystem::remove(file());
  expectSame(resumed, compute(finer, 0));
}

TEST_F(PointReferences, TimeUsedUpEndsTheWorkForGood) {
  const PointConfidence hopeless{.noise = 0, .capSeconds = 1e-9};
  const PointReference one = compute(hopeless);
  EXPECT_FALSE(one.reached);
  EXPECT_EQ(compute(hopeless).samplesPerPoint, one.samplesPerPoint);
}

TEST_F(PointReferences, BrokenAndForeignFilesAreComputedAnewWithAWarning) {
  const PointReference whole = compute(passable());
  const auto size = std::filesystem::file_size(file());
  const std::vector<std::function<void()>> faults{
      [&] { std::filesystem::resize_file(file(), size - 1); },
      [&] { std::fstream(file(), std::ios::in | std::ios::out | std::ios::binary).seekp(100).put('\x55'); },
      [&] {  // another reference under this one's name
        const PointTask other{.points = 24, .seed = 9};
        computePointReference(cornell(), other, passable(), 2, {}, warnings_);
        std::filesystem::copy_file(referenceFile(pointReferenceKey(cornell().scene, other)), file(),
                                   std::filesystem::copy_options::overwrite_existing);
      }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    faults[i]();
    warnings_.clear();
    const PointReference anew = compute(passable());
    ASSERT_EQ(warnings_.size(), 1u) << "fault " << i;
    EXPECT_NE(warnings_[0].find("computing it anew"), std::string::npos) << warnings_[0];
    expectSame(whole, anew);
  }
}

TEST_F(PointReferences, TheGatherOfAllTexelsNearsThem) {
  const auto opened = charted(128);
  GatheredMaps gathered(*opened, 1, 2);
  gathered.growTo(1, {});
  const PointTask many{.points = 1024};
  const PointReference reference =
      computePointReference(cornell(), many, {.noise = 10, .capSeconds = 1e6}, 2, {}, warnings_);
  double seconds = 0;
  const core::IlluminationMaps maps = gathered.maps(seconds);
  EXPECT_GT(seconds, 0);
  opened->world->setMaps(&maps);
  std::vector<Vec3> found;
  for (const raytrace::SurfacePoint& p : reference.points)
    found.push_back(raytrace::mapIrradiance(*opened->world, p));
  const MapError error = errorOf(found, reference.truth);
  // Noisy, but unbiased: the mean over the points is as near as the noise of so many of them allows.
  EXPECT_GT(error.relative, 0.02);
  EXPECT_NEAR(error.bias, 0, 4 * error.relative / std::sqrt(static_cast<double>(error.lit)));

  const std::filesystem::path csv = cache_.folder().path() / "worst.csv";
  writeWorstPoints(csv, *opened->world, reference, found, 3);
  const std::string text = tests::slurp(csv);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
  EXPECT_EQ(text.rfind("x,y,z,object,side,map,reference,deviation,share\n", 0), 0u);
}

}  // namespace
}  // namespace saccade::bench
