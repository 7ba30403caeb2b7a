// The panel and the keys that go with it, by real events: each step is asserted on the viewer's state and on
// the screen.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "core/composite.h"
#include "core/image_io.h"
#include "render/window/window.h"
#include "tests/unit/app/driven_viewer.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

class WindowPanel : public ::testing::Test {
 protected:
  void SetUp() override { SACCADE_NEEDS_A_DISPLAY_TO_DRIVE(); }
  OwnFolders folders_;
};

/// Where a slider's grab is, as a part of its width: the middle of what differs from the frame's colour in a
/// row below its text.
double grabOf(const core::ImageRgba8& slider) {
  const int y = slider.height() - 4;
  std::map<std::tuple<int, int, int>, int> counts;
  const auto key = [&](int x) {
    const core::Rgba8 c = slider.at(x, y);
    return std::tuple<int, int, int>(c.r, c.g, c.b);
  };
  for (int x = 0; x < slider.width(); ++x) ++counts[key(x)];
  const auto frame = std::max_element(counts.begin(), counts.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  double sum = 0;
  int n = 0;
  for (int x = 2; x < slider.width() - 2; ++x) {
    if (key(x) == frame->first) continue;
    sum += x;
    ++n;
  }
  return n > 0 ? sum / n / slider.width() : -1;
}

double brightness(const core::ImageRgba8& image) {
  double sum = 0;
  for (const core::Rgba8& p : image.pixels()) sum += p.r + p.g + p.b;
  return sum / (3.0 * static_cast<double>(image.pixels().size()));
}

TEST_F(WindowPanel, TheSliderSetsAttention) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    EXPECT_FLOAT_EQ(viewer.state().panel.attention, 0.5f);
    EXPECT_NEAR(grabOf(viewer.control("attention")), 0.5, 0.05);
    const core::Camera before = *viewer.state().camera;
    viewer.dragOn("attention", 0.5, 0.85);
    EXPECT_NEAR(viewer.state().panel.attention, 0.85f, 0.06f);
    viewer.until("its grab is where the mouse let go",
                 [&] { return std::abs(grabOf(viewer.control("attention")) - 0.85) < 0.05; });
    viewer.dragOn("attention", 0.85, -2);  // beyond the panel: over the picture
    EXPECT_EQ(viewer.state().panel.attention, 0);
    EXPECT_TRUE(viewer.state().camera->samePicture(before)) << "the slider's drag turned the camera";
    viewer.hold("d", "keys walk after a drag", [&] { return viewer.state().camera->eye != before.eye; });
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, ExposureBrightensThePicture) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const double before = brightness(viewer.picture());
    viewer.dragOn("exposure", 0.5, 0.62);
    EXPECT_GT(viewer.state().panel.exposureEv, 0.5f);
    viewer.untilConverged();
    EXPECT_GT(brightness(viewer.picture()), 1.1 * before);
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, CorrectionsAndReuseGoOffAndOnByKeyAndByMouse) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::ImageRgba8 corrected = viewer.picture(), on = viewer.control("corrections");
    const auto without = [&] {
      return !viewer.state().panel.corrections && pixelsThatDiffer(viewer.picture(), corrected) > 500 &&
             viewer.picture().pixels() == viewer.state().loop->display().pixels();
    };
    viewer.x().press("c");
    viewer.until("the base layer alone", without);
    viewer.x().press("c");
    viewer.until("corrections again", [&] { return viewer.state().panel.corrections; });
    viewer.untilConverged();
    EXPECT_EQ(viewer.picture().pixels(), corrected.pixels());
    viewer.clickOn("corrections", 0.1);
    viewer.until("the base layer alone, by mouse", without);
    viewer.x().moveTo(100, 100);
    viewer.until("the box is empty",
                 [&] { return pixelsThatDiffer(viewer.control("corrections"), on) > 10; });
    viewer.clickOn("corrections", 0.1);
    viewer.until("corrections by mouse", [&] { return viewer.state().panel.corrections; });

    viewer.x().moveTo(100, 100);
    viewer.frames(2);
    const core::ImageRgba8 reuse = viewer.control("reuse");
    viewer.x().press("r");
    viewer.until("no reuse", [&] {
      return !viewer.state().panel.reuse && pixelsThatDiffer(viewer.control("reuse"), reuse) > 10;
    });
    viewer.clickOn("reuse", 0.1);
    viewer.until("reuse by mouse", [&] { return viewer.state().panel.reuse; });
    viewer.untilConverged();
    EXPECT_EQ(viewer.picture().pixels(), corrected.pixels());
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, OverlaysByKey) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::ImageRgba8 plain = viewer.picture();
    std::map<app::Aov, core::ImageRgba8> seen;
    for (std::size_t i = 0; i < app::aovNames().size(); ++i) {
      const auto aov = static_cast<app::Aov>(i);
      viewer.x().press(std::to_string(i + 1));
      viewer.until("overlay " + app::aovNames()[i], [&] {
        return viewer.state().panel.overlay == aov && pixelsThatDiffer(viewer.picture(), plain) > 1000;
      });
      viewer.frames(2);
      seen[aov] = viewer.picture();
    }
    // Objects are as many colours as they are: few.
    std::map<std::tuple<int, int, int>, int> colors;
    for (const core::Rgba8& c : seen[app::Aov::id].pixels()) ++colors[{c.r, c.g, c.b}];
    EXPECT_LE(colors.size(), viewer.state().loop->frame().extents.size() + 1);
    EXPECT_GE(colors.size(), 3u);
    for (const auto& [a, one] : seen) {
      for (const auto& [b, other] : seen) {
        if (a < b && !(pixelsThatDiffer(one, other) > 1000))
          ADD_FAILURE() << app::aovNames()[static_cast<std::size_t>(a)] << " looks like "
                        << app::aovNames()[static_cast<std::size_t>(b)];
      }
    }
    viewer.x().press("0");
    viewer.until("no overlay", [&] { return !viewer.state().panel.overlay; });
    viewer.untilConverged();
    EXPECT_EQ(viewer.picture().pixels(), plain.pixels());
  });
  EXPECT_EQ(status, 0);
}

/// The panel's part of the screen.
core::ImageRgba8 panelOf(const DrivenViewer& viewer) {
  const app::ViewerState& state = viewer.state();
  return crop(viewer.screen(), {state.width - state.panelWidth, 0, state.panelWidth, state.height});
}

using Color = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>;
std::set<Color> colorsOf(const core::ImageRgba8& image) {
  std::set<Color> colors;
  for (const core::Rgba8& c : image.pixels()) colors.insert({c.r, c.g, c.b});
  return colors;
}

/// How far the nearest of them is, in the channel that differs most.
int distanceTo(const std::set<Color>& colors, const Color& from) {
  const auto [r, g, b] = from;
  int nearest = 255;
  for (const auto& [r2, g2, b2] : colors)
    nearest = std::min(nearest, std::max({std::abs(r - r2), std::abs(g - g2), std::abs(b - b2)}));
  return nearest;
}

/// Opens the list of overlays and clicks on one.
void chooseByMouse(DrivenViewer& viewer, const std::string& name) {
  viewer.clickOn("overlay");
  viewer.until("the list is open", [&] { return viewer.state().items.at("overlay " + name).width > 0; });
  viewer.frames(2);  // the list finds its size in its first ones
  viewer.clickOn("overlay " + name);
  viewer.until("the list is gone", [&] { return viewer.state().items.at("overlay none").width == 0; });
  viewer.x().moveTo(100, 100);  // nothing in the panel is lit up
  viewer.frames(3);
}

// Categories are drawn in the very colours of their legend's squares.
TEST_F(WindowPanel, AnOverlayChosenByMouseHasItsLegendBesideIt) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::ImageRgba8 plain = viewer.picture();
    for (const app::Aov aov : {app::Aov::id, app::Aov::level}) {
      const std::string& name = app::aovNames()[static_cast<std::size_t>(aov)];
      chooseByMouse(viewer, name);
      ASSERT_EQ(viewer.state().panel.overlay, aov);
      const std::set<Color> colors = colorsOf(viewer.picture());
      ASSERT_GE(colors.size(), 3u) << name;
      ASSERT_LE(colors.size(), app::AovLegend::kMostSwatches + 1) << name;  // and black
      const core::ImageRgba8 panel = panelOf(viewer);
      for (const auto& [r, g, b] : colors) {
        EXPECT_GE(pixelsOf(panel, {r, g, b, 255}), 100u)
            << name << " has no square of " << int{r} << " " << int{g} << " " << int{b};
      }
    }
    chooseByMouse(viewer, "none");
    EXPECT_FALSE(viewer.state().panel.overlay);
    viewer.untilConverged();
    EXPECT_EQ(viewer.picture().pixels(), plain.pixels());
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, ARampsColoursAreInItsLegend) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    chooseByMouse(viewer, "saliency");
    ASSERT_EQ(viewer.state().panel.overlay, app::Aov::saliency);
    const std::set<Color> legend = colorsOf(panelOf(viewer)), seen = colorsOf(viewer.picture());
    EXPECT_GT(seen.size(), 30u);
    int farthest = 0;
    for (const Color& color : seen) farthest = std::max(farthest, distanceTo(legend, color));
    // The legend has 64 of the ramp's colours; half of what lies between two of them.
    EXPECT_LE(farthest, 4);
  });
  EXPECT_EQ(status, 0);
}

// Pointer and button in one frame: what counts is where the pointer is, not where it was a frame before.
TEST_F(WindowPanel, AHastyClickIsWhereThePointerIs) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::FrameSnapshot& frame = viewer.state().loop->frame();
    const std::uint32_t id = largestOf(frame);
    const auto [x, y] = pixelOf(frame, id);
    const render::PixelRect reuse = viewer.state().items.at("reuse");
    viewer.x().moveTo(reuse.x + 5, reuse.y + 5);
    viewer.frames(3);
    viewer.x().click(x, y);
    viewer.until("the object is picked",
                 [&] { return viewer.state().tools->picked() && viewer.state().tools->picked()->id == id; });
    const core::Camera before = *viewer.state().camera;
    viewer.x().moveTo(100, 100);
    viewer.frames(3);
    viewer.x().click(reuse.x + 5, reuse.y + 5);
    viewer.until("the box in the panel is ticked", [&] { return !viewer.state().panel.reuse; });
    EXPECT_EQ(viewer.state().tools->picked()->id, id);
    EXPECT_TRUE(viewer.state().camera->samePicture(before));
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, AnExrIsTheLightThatIsShown) {
  app::WalkOptions options = drivenOptions();
  options.run.exposureEv = 0.5f;
  core::Camera camera;
  const app::Workspace& workspace = workspaceOf(bundled("cornell.glb"));  // the viewer bakes the same maps
  const int status = DrivenViewer::run(options, [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::ImageRgba8 shown = viewer.picture();
    camera = *viewer.state().camera;
    viewer.x().keyDown("Shift_L");
    viewer.x().press("F12");
    viewer.until("a message", [&] { return viewer.state().panel.message.ends_with("saccade_0001.exr"); });
    viewer.x().keyUp("Shift_L");
    const core::ImageRgb light = core::readExr("saccade_0001.exr");
    EXPECT_EQ(largestDifference(light, rayTraced(workspace, viewer.state().loop->frame())), 0);
    EXPECT_EQ(core::toDisplay(light, 0.5f).pixels(), shown.pixels());
    // Neither overlay nor exposure is light.
    viewer.x().press("1");
    viewer.dragOn("exposure", 0.5, 0.7);
    viewer.until("an overlay in another exposure", [&] {
      return viewer.state().panel.overlay && std::abs(viewer.state().panel.exposureEv - 0.5f) > 0.5f;
    });
    viewer.clickOn("exr");
    viewer.until("a second file", [&] { return viewer.state().panel.message.ends_with("saccade_0002.exr"); });
    EXPECT_EQ(core::readExr("saccade_0002.exr").pixels(), light.pixels());
    EXPECT_FALSE(std::filesystem::exists("saccade_0001.png")) << "Shift saves no screenshot beside it";
  });
  EXPECT_EQ(status, 0);
  // As `saccade render` makes it of the same camera, without a window.
  app::Headless gl(runOn("osmesa"), workspace);
  app::FrameLoop still(workspace, *gl.renderer, {});
  still.step(camera, options.size, app::FrameBudget::untilConverged());
  if (render::Window(64, 64, "").context().renderer() == gl.context->renderer()) {
    EXPECT_EQ(largestDifference(core::readExr("saccade_0001.exr"), still.linear()), 0);
  }
}

TEST_F(WindowPanel, AnExrWithoutCorrectionsIsTheBaseLayer) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    viewer.x().press("c");
    viewer.until("the base layer alone", [&] {
      return !viewer.state().panel.corrections &&
             viewer.picture().pixels() == viewer.state().loop->display().pixels();
    });
    viewer.clickOn("exr");
    viewer.until("a message", [&] { return viewer.state().panel.message.ends_with("saccade_0001.exr"); });
    const core::ImageRgb light = core::readExr("saccade_0001.exr");
    const core::FrameSnapshot& frame = viewer.state().loop->frame();
    EXPECT_EQ(light.pixels(),
              core::compositeLinear(light.width(), light.height(), frame.baseAndId, {}).pixels());
    EXPECT_EQ(core::toDisplay(light, 0).pixels(), viewer.picture().pixels());
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, AScreenshotIsThePictureThatIsShown) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::ImageRgba8 shown = viewer.picture();
    viewer.x().press("F12");
    viewer.until("a message",
                 [&] { return viewer.state().panel.message.find("saved") != std::string::npos; });
    EXPECT_EQ(core::readImage8("saccade_0001.png").pixels(), shown.pixels());
    viewer.clickOn("screenshot");
    viewer.until("a second file", [&] { return std::filesystem::exists("saccade_0002.png"); });
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowPanel, ThePanelAndTheListOfKeysComeAndGo) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    viewer.x().press("F1");
    viewer.until("the list of keys over the picture", [&] {
      return viewer.state().panel.showKeys &&
             pixelsThatDiffer(viewer.picture(), viewer.state().loop->display()) > 5000;
    });
    viewer.x().press("F1");
    viewer.until("no list", [&] { return !viewer.state().panel.showKeys; });
    viewer.untilConverged();
    viewer.x().press("Tab");
    viewer.until("the picture has the whole window", [&] {
      return !viewer.state().panel.visible && viewer.state().loop->display().width() == viewer.state().width;
    });
    viewer.untilConverged();
    EXPECT_EQ(viewer.picture().width(), 640);
    viewer.x().press("Tab");
    viewer.until("the panel again", [&] { return viewer.state().panel.visible; });
    viewer.untilConverged();
    EXPECT_EQ(viewer.picture().width(), 640 - app::kPanelWidth);
  });
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace saccade::tests
