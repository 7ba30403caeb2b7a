// What stands in for corrections: nearer to the truth than the base layer, and no part of what corrections
// converge to.
#include <gtest/gtest.h>

#include <cmath>

#include "app/recording/session_check.h"
#include "core/image_io.h"
#include "tests/unit/app/recording_fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using app::FrameLoopOptions;
using tests::cameraAt;
using tests::cornell;
using tests::kSmall;

constexpr app::ImageSize kSize{128, 128};

/// In an order that does not depend on the picture, so that the same samples are taken with and without.
FrameLoopOptions with(bool approximation, int threads = 0) {
  FrameLoopOptions o;
  o.threads = threads;
  o.corrective.approximation = approximation;
  o.corrective.attention.order = attention::Order::scanline;
  return o;
}

/// Root mean square over the mask's pixels and channels, of what is displayed in [0, 1].
double maskedError(const core::FrameSnapshot& frame, const core::ImageRgb& truth,
                   const core::ImageRgb& test) {
  const core::ImageRgba8 a = core::toDisplay(truth, 0), b = core::toDisplay(test, 0);
  double sum = 0;
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    if (frame.ids[i] == 0) continue;
    const core::Rgba8 p = a.pixels()[i], q = b.pixels()[i];
    for (const int d : {p.r - q.r, p.g - q.g, p.b - q.b}) sum += d * d / (255.0 * 255.0);
  }
  return std::sqrt(sum / (3.0 * frame.nonDiffusePixels));
}

/// Error of the base layer alone, and of what is shown without any sample.
void expectNearer(const std::filesystem::path& scene, double atMost) {
  const app::Workspace& workspace = tests::workspaceOf(scene);
  const app::Headless gl(tests::runOn("osmesa"), workspace);
  app::FrameLoopOptions options = with(true);
  options.probesAFrame = render::Approximation::kMostProbes;
  FrameLoop loop(workspace, *gl.renderer, options);
  loop.step(workspace.scene.cameras.at(0), kSize, FrameBudget::firstSamples(0));
  const core::ImageRgb truth = tests::rayTraced(workspace, loop.frame());
  const core::ImageRgb base = core::compositeLinear(kSize.width, kSize.height, loop.frame().baseAndId, {});
  const double before = maskedError(loop.frame(), truth, base);
  const double after = maskedError(loop.frame(), truth, loop.linear());
  testing::Test::RecordProperty("base", std::to_string(before));
  testing::Test::RecordProperty("probe", std::to_string(after));
  EXPECT_LT(after, atMost * before) << after << " instead of " << before;
  EXPECT_EQ(core::toDisplay(loop.linear(), 0).pixels(), loop.display().pixels());
  EXPECT_EQ(loop.stats().samplesTraced, 0u);
}

// Chrome and glass balls, a brushed box.
TEST(Approximation, IsNearerThanTheBaseLayerInARoomOfChromeAndGlass) {
  expectNearer(tests::bundled("cornell.glb"), 0.5);
}

TEST(Approximation, IsNearerThanTheBaseLayerAtATableWithGlasses) {
  expectNearer(tests::bundled("table.glb"), 0.5);
}

TEST(Approximation, IsNearerThanTheBaseLayerInASharedSceneOfChromeAndGlass) {
  SACCADE_SHARED_FILE(file, "scenes/cornell/CornellBox-Sphere.obj");
  expectNearer(file, 0.5);
}

TEST(Approximation, TheConvergedPictureIsTheSameBitForBit) {
  const app::Headless gl(tests::runOn("osmesa"), cornell());
  for (const int threads : {0, 2}) {
    FrameLoop on(cornell(), *gl.renderer, with(true, threads)), off(cornell(), *gl.renderer, with(false));
    for (int i = 0; i < 4; ++i) on.step(cameraAt(0.2 * i), kSmall, FrameBudget::firstSamples(100));
    on.step(cameraAt(1), kSmall, FrameBudget::untilConverged());
    off.step(cameraAt(1), kSmall, FrameBudget::untilConverged());
    ASSERT_TRUE(on.converged() && off.converged());
    EXPECT_EQ(on.linear().pixels(), off.linear().pixels());
    EXPECT_EQ(on.display().pixels(), off.display().pixels());
    EXPECT_EQ(on.linear().pixels(), tests::rayTraced(cornell(), on.frame()).pixels());
  }
}

TEST(Approximation, ChangesOnlyPixelsWithoutASplat) {
  const app::Headless gl(tests::runOn("osmesa"), cornell());
  FrameLoop on(cornell(), *gl.renderer, with(true)), off(cornell(), *gl.renderer, with(false));
  int bare = 0, changed = 0;
  for (int i = 0; i < 5; ++i) {
    for (FrameLoop* loop : {&on, &off}) loop->step(cameraAt(0.5 * i), kSmall, FrameBudget::firstSamples(60));
    for (int y = 0; y < kSmall.height; ++y) {
      for (int x = 0; x < kSmall.width; ++x) {
        const bool isBare = on.frame().idAt(x, y) != 0 && on.layer().shownAt(x, y) == nullptr;
        const bool differs = on.display().at(x, y) != off.display().at(x, y);
        EXPECT_TRUE(isBare || !differs) << x << ", " << y;
        bare += isBare;
        changed += differs;
      }
    }
    const auto a = on.corrections(), b = off.corrections();
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    EXPECT_EQ(on.cache().size(), off.cache().size());
    EXPECT_EQ(on.stats().samplesTraced, off.stats().samplesTraced);
  }
  EXPECT_GT(bare, 200) << "something to see";
  EXPECT_GT(changed, bare / 2);
}

TEST(Approximation, IsNotShownWhereCorrectionsAreOff) {
  const app::Headless gl(tests::runOn("osmesa"), cornell());
  FrameLoop on(cornell(), *gl.renderer, with(true)), off(cornell(), *gl.renderer, with(false));
  for (FrameLoop* loop : {&on, &off}) {
    loop->showCorrections(false);
    loop->step(cameraAt(0), kSmall, FrameBudget::firstSamples(20));
  }
  EXPECT_EQ(on.display().pixels(), off.display().pixels());
  on.showCorrections(true);
  on.step(cameraAt(0), kSmall, FrameBudget::firstSamples(0));
  EXPECT_NE(on.display().pixels(), off.display().pixels());
}

TEST(Approximation, IsTheSameOnAnyNumberOfThreads) {
  const app::Headless gl(tests::runOn("osmesa"), cornell());
  tests::Pictures first;
  for (const int threads : {0, 1, 3}) {
    FrameLoop loop(cornell(), *gl.renderer, with(true, threads));
    tests::Pictures shown;
    for (int i = 0; i < 4; ++i) {
      loop.step(cameraAt(0.4 * i), kSmall, FrameBudget::firstSamples(80));
      shown.push_back(loop.display());
    }
    if (first.empty()) first = shown;
    EXPECT_EQ(tests::firstDifference(first, shown), -1) << threads << " threads";
  }
}

/// A walk along which the approximation is turned off and on again.
tests::Pictures recordSwitched(const std::filesystem::path& file) {
  return tests::recordWalk(file, with(true, 2), 12, [](FrameLoop& loop, int i) {
    loop.approximate(i < 4 || i > 7);
    loop.step(cameraAt(0.5 * (i / 2)), kSmall, FrameBudget::firstSamples(50));
  });
}

TEST(Approximation, IsReplayedWithoutATracer) {
  const auto file = tests::temporaryFolder() / "approximated.session";
  const tests::Pictures shown = recordSwitched(file);
  EXPECT_EQ(tests::firstDifference(shown, tests::replayed(file).shown), -1);
  // Or the recording would not hang on it.
  tests::alter(file, "UPDATE settings SET value = 0 WHERE name = 'approximation'");
  app::SessionReader session(file);
  const auto workspace = app::openRecorded(session, "", "");
  const app::Headless gl(tests::runOn("osmesa"), *workspace);
  app::SessionReplay replay(session, workspace->scene, *gl.renderer);
  ASSERT_TRUE(replay.next());
  EXPECT_NE(app::frameHash(replay.display()), replay.frame().hash);
}

TEST(Approximation, ARecordingOfBeforeThereWasOneIsReplayedWithoutIt) {
  const auto file = tests::temporaryFolder() / "before.session";
  const tests::Pictures shown = tests::recordWalk(file, with(false), 4, [](FrameLoop& loop, int i) {
    loop.step(cameraAt(0.5 * i), kSmall, FrameBudget::firstSamples(50));
  });
  tests::alter(file, "DELETE FROM settings WHERE name = 'approximation'; PRAGMA user_version = 1");
  EXPECT_EQ(tests::firstDifference(shown, tests::replayed(file).shown), -1);
}

}  // namespace
}  // namespace saccade
