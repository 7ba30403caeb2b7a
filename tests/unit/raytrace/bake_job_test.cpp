// Bakes as jobs: paused anywhere, on any threads, the same bits.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "raytrace/bake/parallel.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;

/// A room with a lamp and a thin double-sided sheet in it: both layers, shadows, indirect light.
core::Scene roomWithSheet() {
  Builder b;
  b.box(Builder::matte(0.6f), Vec3(0), Vec3(2), true);
  core::Material paper = Builder::matte(0.5f);
  paper.doubleSided = true;
  b.quad(paper, Vec3(0.5f, 1, 1.5f), Vec3(1, 0, 0), Vec3(0, 0, -1));
  b.quad(Builder::matte(0, Vec3(5)), Vec3(0.8f, 1.9f, 0.8f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  return std::move(b.scene);
}

struct Charted {
  core::Scene scene = roomWithSheet();
  core::Plan plan;
  ChartAtlas atlas;
  std::unique_ptr<World> world;

  explicit Charted(int size = 64) {
    plan.lightmapSize = size;
    atlas = makeCharts(scene, plan, size);
    core::applyCharts(scene, atlas.charts);
    world = std::make_unique<World>(scene, plan);
  }
};

BakeOptions small(int threads) {
  BakeOptions o;
  o.quality = "medium";
  o.photons = 50001;  // the last batch is not a whole one
  o.threads = threads;
  return o;
}

TEST(BakeJob, PausedAfterEveryPieceOfWorkOnAnyThreadsTheBitsAreTheSame) {
  const Charted room;
  const core::IlluminationMaps whole =
      bakeMaps(*room.world, room.atlas.charts, room.atlas.size, small(2), {});
  ASSERT_EQ(whole.layers, 2);
  for (const int threads : {0, 1, 3}) {
    BakeJob job(*room.world, room.atlas.size, small(threads));
    int pauses = 0;
    while (!job.advance(stopped(), {})) ++pauses;
    EXPECT_GT(pauses, threads == 3 ? 10 : 30);
    const core::IlluminationMaps maps = job.finish(room.atlas.charts, {}, {});
    EXPECT_EQ(maps.texels, whole.texels) << threads << " threads";
  }
}

TEST(BakeJob, AnotherJobGoesOnFromItsResults) {
  const Charted room;
  const core::IlluminationMaps whole =
      bakeMaps(*room.world, room.atlas.charts, room.atlas.size, small(0), {});
  auto job = std::make_unique<BakeJob>(*room.world, room.atlas.size, small(0));
  for (int piece = 0; !job->advance(stopped(), {}); ++piece) {
    if (piece % 7 != 0) continue;
    auto next = std::make_unique<BakeJob>(*room.world, room.atlas.size, small(piece % 3));
    for (std::size_t i = 0; i < next->stages().size(); ++i) {
      BakeStage& to = next->stages()[i];
      const BakeStage& from = job->stages()[i];
      ASSERT_EQ(to.results.size(), from.results.size());
      to.done = from.done;
      std::memcpy(to.results.data(), from.results.data(), from.results.size());
    }
    job = std::move(next);
  }
  EXPECT_EQ(job->finish(room.atlas.charts, {}, {}).texels, whole.texels);
}

TEST(BakeJob, EveryStageIsNamedWhileItIsWorkedOn) {
  const Charted room;
  std::vector<std::string> seen;
  BakeJob job(*room.world, room.atlas.size, small(2));
  const BakeReport report = [&](const BakeProgress& p) {
    EXPECT_GE(p.secondsLeft, 0);
    if (seen.empty() || seen.back() != p.stage) seen.emplace_back(p.stage);
  };
  ASSERT_TRUE(job.advance({}, report));
  job.finish(room.atlas.charts, {}, report);
  for (const BakeStage& stage : job.stages()) {
    EXPECT_EQ(stage.done, stage.units) << stage.name;
    EXPECT_NE(std::find(seen.begin(), seen.end(), stage.name), seen.end()) << stage.name;
  }
  EXPECT_EQ(seen.back(), "smoothing");
}

TEST(BlockOrder, EveryBlockOnceAndEveryBeginningSpreadOut) {
  for (const std::size_t count : {1u, 2u, 3u, 16u, 100u, 4096u, 4097u}) {
    const BlockOrder order(count);
    std::vector<int> times(count);
    for (std::size_t i = 0; i < count; ++i) ++times[order.at(i)];
    EXPECT_EQ(times, std::vector<int>(count, 1)) << count;
    if (count < 100) continue;
    std::vector<int> tenth(10);  // of the first tenth, how many lie in each tenth of the atlas
    for (std::size_t i = 0; i < count / 10; ++i) ++tenth[order.at(i) * 10 / count];
    for (const int n : tenth) EXPECT_NEAR(n, static_cast<double>(count) / 100, 2) << count;
  }
}

}  // namespace
}  // namespace saccade::raytrace
