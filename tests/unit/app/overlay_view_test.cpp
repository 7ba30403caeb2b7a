// The window's overlay is always the one that a fresh computation gives, and is computed only when it
// changes.
#include "app/viewer/overlay_view.h"

#include <gtest/gtest.h>

#include "tests/unit/app/fixtures.h"

namespace saccade::app {
namespace {

constexpr ImageSize kSize{160, 120};
constexpr int kMaxAge = 30;

bool tellsOfSplats(Aov aov) {
  return aov == Aov::level || aov == Aov::thread || aov == Aov::age || aov == Aov::validity ||
         aov == Aov::footprint;
}
bool tellsOfAnalysis(Aov aov) { return aov == Aov::saliency || aov == Aov::importance; }

class OverlayViews : public testing::TestWithParam<int> {
 protected:
  const Aov aov_ = static_cast<Aov>(GetParam());
  const Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  Headless gl_{tests::runOn("osmesa"), workspace_};
  FrameLoop loop_{workspace_, *gl_.renderer, {.threads = 0}};
  OverlayView view_{loop_, workspace_.scene, kMaxAge};
  core::Camera camera_ = workspace_.scene.cameras[0];

  void step(std::uint64_t samples) { loop_.step(camera_, kSize, FrameBudget::firstSamples(samples)); }

  /// Draws it twice, once half over the picture; whether it was computed for that.
  bool computes() {
    const std::size_t before = view_.computed();
    core::ImageRgba8 shown = loop_.display(), half = loop_.display();
    view_.draw(aov_, 1, shown);
    view_.draw(aov_, 0.5f, half);
    const AovImage image = aovImage(aov_, loop_);
    const AovScale scale(aov_, image.values, kMaxAge);
    core::ImageRgba8 fresh = loop_.display(), freshHalf = loop_.display();
    layOver(aovPicture(image, scale), 1, fresh);
    layOver(aovPicture(image, scale), 0.5f, freshHalf);
    EXPECT_EQ(shown.pixels(), fresh.pixels());
    EXPECT_EQ(half.pixels(), freshHalf.pixels());
    EXPECT_EQ(view_.shown()->scale.aov(), aov_);
    EXPECT_LE(view_.computed(), before + 1) << "never twice for the same";
    return view_.computed() > before;
  }
};

TEST_P(OverlayViews, AreComputedWhenWhatTheyShowHasChanged) {
  core::SampleBatch late;
  loop_.onBatch = [&](const core::SampleBatch& batch) {
    if (late.samples.empty() && !batch.samples.empty())
      late = {batch.epoch, batch.sequence, {batch.samples.front()}};
  };
  step(400);
  EXPECT_TRUE(computes());
  EXPECT_FALSE(computes()) << "nothing has changed";
  camera_.eye.x += 0.01f;
  step(300);
  EXPECT_TRUE(computes()) << "another camera";
  step(0);
  EXPECT_FALSE(computes()) << "at rest without new samples";
  step(700);  // until another object is next
  EXPECT_EQ(computes(), tellsOfSplats(aov_) || aov_ == Aov::rank) << "new samples";
  loop_.setExposure(1);
  step(0);
  EXPECT_FALSE(computes()) << "another exposure";
  loop_.setDelta(1e-4f);
  step(0);
  EXPECT_EQ(computes(), aov_ == Aov::validity) << "another delta";
  ASSERT_EQ(loop_.cache().add(late, late.epoch), 1u);
  EXPECT_EQ(computes(), aov_ == Aov::validity) << "a late sample of an older camera";
  loop_.attend(1);
  step(0);
  EXPECT_EQ(computes(), tellsOfAnalysis(aov_) || aov_ == Aov::rank) << "a click";
}

TEST_P(OverlayViews, AreComputedAnewAfterTheyWereHiddenAndForAnother) {
  step(200);
  EXPECT_TRUE(computes());
  view_.hide();
  EXPECT_FALSE(view_.shown());
  EXPECT_TRUE(computes());
  core::ImageRgba8 picture = loop_.display();
  view_.draw(aov_ == Aov::id ? Aov::level : Aov::id, 1, picture);
  EXPECT_TRUE(computes());
}

INSTANTIATE_TEST_SUITE_P(All, OverlayViews, testing::Range(0, static_cast<int>(aovNames().size())),
                         [](const auto& aov) { return aovNames()[static_cast<std::size_t>(aov.param)]; });

}  // namespace
}  // namespace saccade::app
