// Displays of higher density, by real events: larger letters and a wider panel, the picture as large as it
// was asked for, and a mouse that hits what it points at.
#include <gtest/gtest.h>

#include "tests/unit/app/driven_viewer.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

class WindowScale : public ::testing::Test {
 protected:
  void SetUp() override { SACCADE_NEEDS_A_DISPLAY_TO_DRIVE(); }

  /// Height of the letters and their frame in a slider, in pixels, of a window that is `scale` times as large
  /// as usual in all but the picture.
  static int tryWindow(const app::WalkOptions& options, double scale) {
    int lineHeight = 0;
    const int status = DrivenViewer::run(options, [&](DrivenViewer& viewer) {
      viewer.untilOpen();
      viewer.frames(3);
      const app::ViewerState& state = viewer.state();
      EXPECT_EQ(state.panelWidth, static_cast<int>(app::kPanelWidth * scale));
      EXPECT_EQ(state.width, options.size.width + state.panelWidth);
      EXPECT_EQ(state.height, options.size.height);
      EXPECT_EQ(viewer.screen().width(), state.width) << "all of it is on the screen";
      lineHeight = state.items.at("attention").height;
      viewer.untilConverged();  // which compares the screen with the picture
      EXPECT_EQ(state.loop->display().width(), options.size.width);
      EXPECT_EQ(state.loop->display().height(), options.size.height);
      hit(viewer);
    });
    EXPECT_EQ(status, 0);
    return lineHeight;
  }

 private:
  /// An object in the picture and controls of the panel, by mouse.
  static void hit(DrivenViewer& viewer) {
    const core::FrameSnapshot& frame = viewer.state().loop->frame();
    const std::uint32_t id = largestOf(frame);
    const auto [x, y] = pixelOf(frame, id);
    const core::ImageRgba8 before = viewer.picture();
    viewer.x().click(x, y);
    viewer.until("an object is picked", [&] { return viewer.state().tools->picked().has_value(); });
    EXPECT_EQ(viewer.state().tools->picked()->id, id);
    viewer.until("it is outlined", [&] { return pixelsThatDiffer(viewer.picture(), before) > 20; });
    viewer.dragOn("attention", 0.5, 0.85);
    EXPECT_NEAR(viewer.state().panel.attention, 0.85f, 0.06f);
    const bool reuse = viewer.state().panel.reuse;
    viewer.clickOn("reuse", 0.1);
    EXPECT_NE(viewer.state().panel.reuse, reuse);
  }
  OwnFolders folders_;
};

app::WalkOptions scaled(std::optional<double> scale) {
  app::WalkOptions options = drivenOptions();
  options.uiScale = scale;
  return options;
}

TEST_F(WindowScale, TheOptionMakesLettersAndPanelLarger) {
  const int usual = tryWindow(scaled(1), 1);
  EXPECT_NEAR(tryWindow(scaled(1.5), 1.5), 1.5 * usual, 2);
}

TEST_F(WindowScale, ADenserDisplayDoesSoByItself) {
  const int usual = tryWindow(scaled({}), 1);
  const XResources dense("Xft.dpi:\t192\n");
  EXPECT_NEAR(tryWindow(scaled({}), 2), 2 * usual, 2);
  EXPECT_EQ(tryWindow(scaled(1), 1), usual) << "the option goes before the display";
}

}  // namespace
}  // namespace saccade::tests
