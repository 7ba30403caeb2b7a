// The product's promise: corrections through queues and splats end at the ray-traced image, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "app/session/camera_path.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using app::FrameLoopOptions;
using app::ImageSize;

struct SceneCase {
  const char* name;
  bool shared;  ///< under the shared folder
  float unitScale = 1;
};

void PrintTo(const SceneCase& c, std::ostream* os) { *os << c.name; }

const SceneCase kScenes[] = {{"cornell.glb", false},
                             {"table.glb", false},
                             {"gallery.glb", false},
                             {"ward.glb", false},
                             {"scenes/cornell/CornellBox-Sphere.obj", true},
                             {"scenes/rooms/glass-table.glb", true},
                             {"references/cycles/cornell_glossy.glb", true}};

std::filesystem::path pathOf(const SceneCase& c) {
  return c.shared ? tests::sharedFolder() / c.name : tests::bundled(c.name);
}

class Converge : public testing::TestWithParam<std::tuple<SceneCase, const char*>> {};

TEST_P(Converge, EqualsRayTracedOnAnyNumberOfThreads) {
  const auto& [scene, context] = GetParam();
  if (scene.shared) {
    SACCADE_SHARED_FILE(file, scene.name);
  }
  const app::Workspace& workspace = tests::workspaceOf(pathOf(scene), scene.unitScale);
  app::Headless gl(tests::runOn(context), workspace);
  const ImageSize size{320, 240};
  for (const int threads : {0, 1, 2, 8}) {
    SCOPED_TRACE("threads " + std::to_string(threads));
    FrameLoopOptions options;
    options.threads = threads;
    FrameLoop loop(workspace, *gl.renderer, options);
    loop.step(workspace.scene.cameras[0], size, FrameBudget::untilConverged());
    ASSERT_TRUE(loop.converged());
    EXPECT_GT(loop.frame().nonDiffusePixels, 0u);
    EXPECT_EQ(loop.stats().samplesTraced, loop.frame().nonDiffusePixels);
    EXPECT_GE(tests::levelsThatOccur(loop.stats()), 3);
    EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace, loop.frame())), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Converge,
                         testing::Combine(testing::ValuesIn(kScenes), testing::Values("osmesa", "egl")));

TEST(ManyObjects, AThousandIdsConvergeToRayTraced) {
  const app::Workspace& workspace = tests::workspaceOf(tests::bundled("gallery-1000.glb"));
  app::Headless gl(tests::runOn("osmesa"), workspace);
  FrameLoop loop(workspace, *gl.renderer, {.threads = 2});
  loop.step(workspace.scene.cameras[0], {512, 512}, FrameBudget::untilConverged());
  ASSERT_TRUE(loop.converged());
  int visible = 0;
  for (const core::ObjectExtent& extent : loop.frame().extents) visible += extent.pixels > 0 ? 1 : 0;
  EXPECT_GE(visible, 1000);
  EXPECT_EQ(loop.stats().samplesTraced, loop.frame().nonDiffusePixels);
  EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace, loop.frame())), 0);
}

/// cornell, off screen, small.
class LoopTest : public testing::Test {
 protected:
  const app::Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  app::Headless gl_{tests::runOn("osmesa"), workspace_};
  core::Camera camera_ = workspace_.scene.cameras[0];
  ImageSize size_{200, 150};

  core::ImageRgb converge(FrameLoop& loop) {
    loop.step(camera_, size_, FrameBudget::untilConverged());
    EXPECT_TRUE(loop.converged());
    return loop.linear();
  }
};

TEST_F(LoopTest, APerturbedSampleIsSeenInTheConvergedImage) {
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
  bool perturbed = false;
  loop.onBatch = [&](core::SampleBatch& batch) {
    if (perturbed || batch.samples.empty()) return;
    batch.samples.front().correction.x += 0.25f;
    perturbed = true;
  };
  const core::ImageRgb image = converge(loop);
  ASSERT_TRUE(perturbed);
  EXPECT_GT(tests::largestDifference(image, tests::rayTraced(workspace_, loop.frame())), 0.2f);
}

TEST_F(LoopTest, ShuffledArrivalGivesTheSameImageAtEveryMoment) {
  // The same samples in another order: within each batch, and the batches of a frame reversed by the sample
  // budget's cut.
  FrameLoop ordered(workspace_, *gl_.renderer, {.threads = 0});
  FrameLoop shuffled(workspace_, *gl_.renderer, {.threads = 0});
  std::mt19937 random(7);
  shuffled.onBatch = [&](core::SampleBatch& batch) {
    std::shuffle(batch.samples.begin(), batch.samples.end(), random);
  };
  for (int i = 0; i < 4; ++i) {
    ordered.step(camera_, size_, FrameBudget::firstSamples(300));
    shuffled.step(camera_, size_, FrameBudget::firstSamples(300));
    EXPECT_EQ(tests::largestDifference(ordered.linear(), shuffled.linear()), 0);
  }
}

TEST_F(LoopTest, TheFirstSamplesAreTheSameOnAnyNumberOfThreads) {
  FrameLoop reference(workspace_, *gl_.renderer, {.threads = 0});
  reference.step(camera_, size_, FrameBudget::firstSamples(777));
  EXPECT_EQ(reference.stats().samplesTraced, 777u);
  const core::ImageRgb expected = reference.linear();
  for (const int threads : {1, 2, 8}) {
    FrameLoop loop(workspace_, *gl_.renderer, {.threads = threads});
    loop.step(camera_, size_, FrameBudget::firstSamples(777));
    EXPECT_EQ(loop.stats().samplesTraced, 777u);
    EXPECT_EQ(loop.stats().levels, reference.stats().levels);
    EXPECT_EQ(tests::largestDifference(loop.linear(), expected), 0) << threads << " threads";
  }
}

TEST_F(LoopTest, SampleBudgetsOfSeveralFramesAddUpToConvergence) {
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = 2});
  for (int i = 0; i < 1000 && !loop.converged(); ++i)
    loop.step(camera_, size_, FrameBudget::firstSamples(501));
  ASSERT_TRUE(loop.converged());
  EXPECT_EQ(loop.stats().samplesTraced, loop.frame().nonDiffusePixels);
  EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace_, loop.frame())), 0);
}

class Walk : public LoopTest, public testing::WithParamInterface<std::tuple<int, app::AgingTest>> {};

TEST_P(Walk, OfSixtyFramesThenRestEqualsRayTraced) {
  const app::CameraPath path = app::CameraPath::orbit(camera_, 30);
  const auto [threads, aging] = GetParam();
  FrameLoop loop(workspace_, *gl_.renderer,
                 {.corrective = {.aging = aging}, .threads = threads, .asynchronousAnalysis = threads > 0});
  for (int i = 59; i >= 0; --i) {
    loop.step(path.at(i / 25.0), size_, FrameBudget::untilDeadline(std::chrono::milliseconds(5)));
  }
  EXPECT_GT(loop.stats().samplesReused, 0u);
  const std::uint64_t tracedWhileWalking = loop.stats().samplesTraced;
  const std::uint32_t exactBefore = loop.layer().exactCount();
  loop.step(camera_, size_, FrameBudget::untilConverged());
  ASSERT_TRUE(loop.converged());
  EXPECT_EQ(loop.stats().samplesTraced - tracedWhileWalking, loop.frame().nonDiffusePixels - exactBefore);
  EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace_, loop.frame())), 0);
}
INSTANTIATE_TEST_SUITE_P(Threads, Walk,
                         testing::Combine(testing::Values(0, 1, 2, 8),
                                          testing::Values(app::AgingTest::haber, app::AgingTest::change)));

TEST_F(LoopTest, AWalkOfSampleBudgetsIsTheSameOnAnyNumberOfThreads) {
  const app::CameraPath path = app::CameraPath::orbit(camera_, 30);
  for (const app::AgingTest aging : {app::AgingTest::haber, app::AgingTest::change}) {
    std::vector<core::ImageRgb> expected;
    for (const int threads : {0, 2}) {
      FrameLoop loop(workspace_, *gl_.renderer,
                     {.corrective = {.aging = aging, .delta = 0.05f}, .threads = threads});
      for (std::size_t i = 0; i < 6; ++i) {
        loop.step(path.at(static_cast<double>(i) / 5), size_, FrameBudget::firstSamples(600));
        if (threads == 0) {
          expected.push_back(loop.linear());
        } else {
          EXPECT_EQ(tests::largestDifference(loop.linear(), expected[i]), 0) << "frame " << i;
        }
      }
      EXPECT_GT(loop.stats().samplesDropped, 0u);
    }
  }
}

TEST_P(Walk, OfAFullCacheThenRestEqualsRayTraced) {
  const app::CameraPath path = app::CameraPath::orbit(camera_, 30);
  const auto [threads, aging] = GetParam();
  FrameLoopOptions options{
      .corrective = {.aging = aging}, .threads = threads, .asynchronousAnalysis = threads > 0};
  options.corrective.cacheMb = 1;  // some 14,600 samples
  FrameLoop loop(workspace_, *gl_.renderer, options);
  for (int i = 1; i <= 8; ++i) loop.step(path.at(i / 25.0), {640, 480}, FrameBudget::firstSamples(6000));
  const std::size_t bound = std::size_t{1} << 20;
  EXPECT_LE(loop.cache().bytes(), bound);
  EXPECT_GT(loop.cache().bytes(), bound - (std::size_t{16} << 10)) << "full";
  loop.step(camera_, {640, 480}, FrameBudget::untilConverged());
  ASSERT_TRUE(loop.converged());
  EXPECT_LE(loop.cache().bytes(), bound);
  EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace_, loop.frame())), 0);
}

TEST_F(LoopTest, AFullCacheKeepsWhatWasHandedOutFirstOfTheOldestAge) {
  // Beside it a cache with room for all, which is given the same samples: of the oldest age that the full one
  // holds, it holds a prefix in the queue's order.
  FrameLoopOptions options{.threads = 0};
  options.corrective.cacheMb = 1;
  options.corrective.delta = 2;
  options.corrective.attention.order = attention::Order::largest;  // whatever the picture shows
  FrameLoop loop(workspace_, *gl_.renderer, options);
  std::vector<core::SampleBatch> batches;
  loop.onBatch = [&](core::SampleBatch& batch) { batches.push_back(batch); };
  render::SampleCache roomy(std::size_t{64} << 20);
  render::CorrectionLayer layer;
  const app::CameraPath path = app::CameraPath::orbit(camera_, 30);
  for (int i = 1; i <= 8; ++i) {
    const std::size_t before = batches.size();
    loop.step(path.at(i / 25.0), {640, 480}, FrameBudget::firstSamples(6000));
    const auto frame = std::make_shared<core::FrameSnapshot>(loop.frame());
    roomy.age(frame->view, {options.corrective.nMin, options.corrective.delta, options.corrective.maxAge});
    layer.beginFrame(frame);
    roomy.warp(*frame, layer);
    for (std::size_t b = before; b < batches.size(); ++b) roomy.add(batches[b], frame->epoch);
  }
  using PixelSet = std::set<std::pair<int, int>>;
  PixelSet kept, all;
  std::uint64_t oldest = 0;
  loop.cache().forEach([&](const core::Sample& s, std::uint64_t age) {
    if (oldest == 0) oldest = age;
    if (age == oldest) kept.insert({s.x, s.y});
  });
  roomy.forEach([&](const core::Sample& s, std::uint64_t age) {
    if (age == oldest) all.insert({s.x, s.y});
  });
  ASSERT_FALSE(kept.empty());
  ASSERT_LT(kept.size(), all.size());
  std::size_t ofPrefix = 0;
  for (const core::SampleBatch& batch : batches) {
    for (const core::Sample& s : batch.samples) {
      // Else of another age, or a younger sample on the same pixel took its place.
      if (batch.epoch != oldest || !all.contains({s.x, s.y}) || ofPrefix == kept.size()) continue;
      ++ofPrefix;
      EXPECT_TRUE(kept.contains({s.x, s.y})) << s.x << ", " << s.y;
    }
  }
  EXPECT_EQ(ofPrefix, kept.size());
}

// In some frame at least: any single one may be interrupted, and a slow machine needs more of them.
TEST_F(LoopTest, FramesThatAreAllLateDoNotFallBehindTheirTracers) {
  constexpr int kLeastFrames = 60, kMostFrames = 3000;
  // A frame that took no more than so many left a backlog that grew to tens of cameras.
  constexpr std::uint64_t kFew = 32;
  FrameLoopOptions options{.threads = 2};
  options.corrective.jobSize = 4;  // many batches a frame
  FrameLoop loop(workspace_, *gl_.renderer, options);
  std::uint64_t newest = 0, taken = 0, mostTaken = 0;
  loop.onBatch = [&](const core::SampleBatch& batch) { newest = std::max(newest, batch.epoch), ++taken; };
  const app::CameraPath path = app::CameraPath::orbit(camera_, 30);
  std::uint64_t leastLag = ~std::uint64_t{0};
  const auto wellDone = [&] { return leastLag <= 1 && mostTaken > kFew; };
  for (int i = 0; i < kLeastFrames || (!wellDone() && i < kMostFrames); ++i) {
    taken = 0;
    loop.step(path.at(i / 25.0), size_, FrameBudget::untilDeadline(std::chrono::milliseconds(0)));
    mostTaken = std::max(mostTaken, taken);
    if (i >= kLeastFrames / 2) leastLag = std::min(leastLag, loop.frame().epoch - newest);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GT(mostTaken, kFew);
  EXPECT_LE(leastLag, 1u);
}

TEST_F(LoopTest, SamplesGoWhereWarpedOnesTellLeast) {
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
  core::Camera camera = camera_;
  loop.step(camera, size_, FrameBudget::firstSamples(1000));
  camera.eye.x += 0.02f;
  std::vector<core::Sample> samples;
  loop.onBatch = [&](const core::SampleBatch& batch) {
    samples.insert(samples.end(), batch.samples.begin(), batch.samples.end());
  };
  loop.step(camera, size_, FrameBudget::firstSamples(0));
  const std::vector<std::uint8_t> known = loop.layer().levels();
  std::size_t covered = 0;
  for (const std::uint8_t level : known) covered += level > 0;
  ASSERT_GT(covered, 1000u);
  loop.step(camera, size_, FrameBudget::firstSamples(1000));
  ASSERT_EQ(samples.size(), 1000u);
  for (const core::Sample& s : samples) EXPECT_LT(known[loop.frame().index(s.x, s.y)], s.level);
}

TEST_P(Walk, BudgetsOfAllKindsMayFollowEachOther) {
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = std::get<0>(GetParam())});
  loop.step(camera_, size_, FrameBudget::firstSamples(333));
  loop.step(camera_, size_, FrameBudget::untilDeadline(std::chrono::milliseconds(2)));
  const std::uint64_t traced = loop.stats().samplesTraced;
  loop.step(camera_, size_, FrameBudget::firstSamples(111));
  EXPECT_EQ(loop.stats().samplesTraced, std::min<std::uint64_t>(traced + 111, loop.frame().nonDiffusePixels));
  loop.step(camera_, size_, FrameBudget::untilConverged());
  ASSERT_TRUE(loop.converged());
  EXPECT_EQ(loop.stats().samplesTraced, loop.frame().nonDiffusePixels);
  EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace_, loop.frame())), 0);
}

TEST_F(LoopTest, AnInlineWalkRepeatsExactly) {
  const app::CameraPath path = app::CameraPath::orbit(camera_, 30);
  std::vector<core::ImageRgba8> first;
  for (int run = 0; run < 2; ++run) {
    FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
    for (int i = 0; i < 8; ++i) {
      loop.step(path.at(i / 25.0), size_, FrameBudget::untilDeadline(std::chrono::milliseconds(2)));
      if (run == 0) {
        first.push_back(loop.display());
      } else {
        EXPECT_EQ(loop.display().pixels(), first[static_cast<std::size_t>(i)].pixels()) << "frame " << i;
      }
    }
  }
}

TEST_F(LoopTest, NothingIsDrawnAgainWhileNothingMoves) {
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
  loop.step(camera_, size_, FrameBudget::firstSamples(10));
  const core::FrameSnapshot* frame = &loop.frame();
  loop.step(camera_, size_, FrameBudget::firstSamples(10));
  EXPECT_EQ(&loop.frame(), frame);
  camera_.eye.x += 0.01f;
  loop.step(camera_, size_, FrameBudget::firstSamples(10));
  EXPECT_GT(loop.frame().epoch, 1u);
}

TEST_F(LoopTest, NoOutputHoldsNaN) {
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
  const core::ImageRgb image = converge(loop);
  for (const core::Vec3& pixel : image.pixels()) {
    ASSERT_TRUE(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z));
  }
}

TEST_F(LoopTest, AStopRequestEndsAConvergingFrame) {
  std::stop_source stop;
  FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
  loop.onBatch = [&](core::SampleBatch&) { stop.request_stop(); };
  loop.step(camera_, size_, FrameBudget::untilConverged(), stop.get_token());
  EXPECT_FALSE(loop.converged());
}

}  // namespace
}  // namespace saccade
