// How the window starts after what it kept, and what it keeps: by its parts, and the window itself closed and
// opened again.
#include "app/viewer/window_settings.h"

#include <gtest/gtest.h>

#include "tests/unit/app/driven_viewer.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

using namespace app;

TEST(WindowSettings, TheCommandLineGoesBeforeWhatWasKept) {
  KeptSettings kept;
  kept.attention = 0.25;
  kept.fps = 50;
  kept.exposureEv = 2;
  kept.delta = 0.25;
  kept.reuse = false;
  kept.approximation = false;
  WalkOptions options;
  options.corrective.approximation = true;
  const WalkOptions all = withKept(options, kept);
  EXPECT_EQ(all.corrective.attention.attention, 0.25f);
  EXPECT_EQ(all.fps, 50);
  EXPECT_EQ(all.run.exposureEv, 2);
  EXPECT_EQ(all.corrective.delta, 0.25f);
  EXPECT_FALSE(all.corrective.approximation);
  EXPECT_FALSE(firstPanel(all, kept).reuse);
  EXPECT_EQ(firstPanel(all, kept).fps, 50);
  EXPECT_TRUE(firstPanel(all, {}).reuse);
  options.given = {
      .size = true, .fps = true, .attention = true, .exposure = true, .delta = true, .approximation = true};
  const WalkOptions none = withKept(options, kept);
  EXPECT_EQ(none.corrective.attention.attention, options.corrective.attention.attention);
  EXPECT_EQ(none.fps, options.fps);
  EXPECT_EQ(none.run.exposureEv, options.run.exposureEv);
  EXPECT_EQ(none.corrective.delta, options.corrective.delta);
  EXPECT_TRUE(none.corrective.approximation);
}

TEST(WindowSettings, OnlyChangesAreKept) {
  KeptSettings kept;
  kept.fps = 50;
  WindowLook start;
  start.size = {800, 600};
  start.panel.fps = 5;  // --fps 5, once
  WindowLook end = start;
  keepChanges(kept, start, end);
  EXPECT_EQ(kept.fps, 50);
  EXPECT_FALSE(kept.window || kept.attention || kept.panelVisible || kept.fullscreen);
  end.panel.fps = 30;
  end.panel.visible = false;
  end.size = {800, 601};
  end.fullscreen = true;
  keepChanges(kept, start, end);
  EXPECT_EQ(kept.fps, 30);
  EXPECT_EQ(kept.panelVisible, false);
  EXPECT_EQ(kept.fullscreen, true);
  ASSERT_TRUE(kept.window);
  EXPECT_EQ(kept.window->height, 601);
  EXPECT_FALSE(kept.attention || kept.reuse);
}

TEST(WindowSettings, TheNextWindowIsAsTheLastWasLeft) {
  SACCADE_NEEDS_A_DISPLAY_TO_DRIVE();
  const OwnFolders folders;
  DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.x().press("c");
    viewer.x().resize(700, 600);
    viewer.until("smaller", [&] { return viewer.state().width == 700 && viewer.state().height == 600; });
    viewer.x().press("F11");
    viewer.until("full screen", [&] { return viewer.state().fullscreen; });
  });
  DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    EXPECT_FALSE(viewer.state().panel.corrections);
    EXPECT_TRUE(viewer.state().panel.reuse);
    EXPECT_TRUE(viewer.state().fullscreen);
    viewer.x().press("F11");
    viewer.until("its old size", [&] { return viewer.state().width == 700 && viewer.state().height == 600; });
  });
  const KeptSettings kept = SettingsFile().load();
  ASSERT_EQ(kept.recent.size(), 1u);
  EXPECT_EQ(kept.recent.front(), bundled("cornell.glb").lexically_normal());
}

}  // namespace
}  // namespace saccade::tests
