// Walking in the real window by real events: each step is asserted on the viewer's state and on the screen.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "tests/unit/app/driven_viewer.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

class WindowWalk : public ::testing::Test {
 protected:
  void SetUp() override { SACCADE_NEEDS_A_DISPLAY_TO_DRIVE(); }
  OwnFolders folders_;
};

core::Vec3 ahead(const core::Camera& camera) { return glm::normalize(camera.at - camera.eye); }

TEST_F(WindowWalk, KeysWalkTheWaysThatTheyName) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    struct Way {
      const char* key;
      core::Vec3 way;  // right, up, forward
    };
    for (const Way& w : {Way{"w", {0, 0, 1}}, Way{"s", {0, 0, -1}}, Way{"a", {-1, 0, 0}}, Way{"d", {1, 0, 0}},
                         Way{"Up", {0, 0, 1}}, Way{"Down", {0, 0, -1}}, Way{"Left", {-1, 0, 0}},
                         Way{"Right", {1, 0, 0}}, Way{"e", {0, 1, 0}}, Way{"q", {0, -1, 0}}}) {
      const core::Camera before = *viewer.state().camera;
      const core::ImageRgba8 picture = viewer.picture();
      const core::Vec3 forward = glm::normalize(ahead(before) * core::Vec3(1, 0, 1));
      const core::Vec3 right = glm::cross(forward, core::Vec3(0, 1, 0));
      viewer.hold(w.key, std::string("the camera moves by ") + w.key,
                  [&] { return glm::distance(viewer.state().camera->eye, before.eye) > 0.1f; });
      viewer.until("the picture moves too",
                   [&] { return pixelsThatDiffer(viewer.picture(), picture) > 1000; });
      const core::Camera& now = *viewer.state().camera;
      const core::Vec3 step = glm::normalize(now.eye - before.eye);
      EXPECT_NEAR(glm::dot(step, right), w.way.x, 1e-3) << w.key;
      EXPECT_NEAR(step.y, w.way.y, 1e-3) << w.key;
      EXPECT_NEAR(glm::dot(step, forward), w.way.z, 1e-3) << w.key;
      EXPECT_LT(glm::length(ahead(now) - ahead(before)), 1e-5f) << w.key << " turned the camera";
    }
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowWalk, TheMouseLooksAndTheWheelZooms) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    const core::Camera home = *viewer.state().camera;
    const core::ImageRgba8 first = viewer.picture();
    viewer.drag(150, 400, 190, 430);
    const core::Camera turned = *viewer.state().camera;
    EXPECT_EQ(turned.eye, home.eye);
    EXPECT_GT(glm::length(ahead(turned) - ahead(home)), 0.02f);
    EXPECT_LT(ahead(turned).y, ahead(home).y) << "a drag downwards looks down";
    viewer.until("the picture turns", [&] { return pixelsThatDiffer(viewer.picture(), first) > 1000; });

    viewer.x().wheel(2);
    viewer.until("the field of view narrows",
                 [&] { return viewer.state().camera->fovYDegrees < home.fovYDegrees * 0.82f; });
    viewer.x().wheel(-2);
    viewer.until("it widens again", [&] {
      return std::abs(viewer.state().camera->fovYDegrees - home.fovYDegrees) < 1e-3f * home.fovYDegrees;
    });

    viewer.x().press("Home");
    viewer.until("the first camera", [&] { return viewer.state().camera->samePicture(home); });
    viewer.untilConverged();
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowWalk, TheCapturedMouseTurnsWithoutBounds) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.x().click(100, 300, 3);
    viewer.until("mouse-look", [&] { return viewer.state().mouseCaptured; });
    viewer.frames(2);
    const core::Vec3 before = ahead(*viewer.state().camera);
    // Half a turn to the right is more than the window is wide.
    for (int i = 0; i < 80; ++i) {
      viewer.x().moveBy(30, 0);
      viewer.frames();
      if (glm::dot(ahead(*viewer.state().camera), before) < -0.9f) break;
    }
    EXPECT_LT(glm::dot(ahead(*viewer.state().camera), before), -0.9f);
    viewer.x().press("Escape");
    viewer.until("the mouse is free", [&] { return !viewer.state().mouseCaptured; });
    viewer.frames(3);  // and the window is still there
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowWalk, AConvergedPictureIsOnTheScreenAtEverySize) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    for (const auto& [width, height] : {std::pair{900, 700}, {500, 400}, {640, 800}}) {
      viewer.x().resize(width, height);
      const core::ImageRgba8 size(width, height);
      viewer.until("the new size", [&] {
        return viewer.state().width == size.width() && viewer.state().height == size.height();
      });
      viewer.untilConverged();
      EXPECT_EQ(viewer.state().loop->display().width(), width - app::kPanelWidth)
          << "the picture fills its place";
      EXPECT_EQ(viewer.state().loop->display().height(), height);
    }
    viewer.x().resize(app::kPanelWidth - 100, 200);
    viewer.until("narrower than the panel", [&] { return viewer.state().width < app::kPanelWidth; });
    viewer.frames(3);
    viewer.x().resize(640, 800);
    viewer.until("wide again", [&] { return viewer.state().width == 640; });
    viewer.untilConverged();
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowWalk, FullScreenAndBack) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    const int width = viewer.state().width, height = viewer.state().height;
    viewer.x().placeAt(37, 53);
    viewer.until("it is elsewhere", [&] { return viewer.x().place() == std::array{37, 53, width, height}; });
    viewer.x().press("F11");
    viewer.until("full screen", [&] { return viewer.state().fullscreen && viewer.state().width > width; });
    EXPECT_EQ(viewer.screen().width(), viewer.state().width);
    EXPECT_EQ(viewer.screen().height(), viewer.state().height);
    viewer.until("a picture that fills it", [&] {
      return viewer.state().loop->display().width() == viewer.pictureArea().width &&
             viewer.picture().pixels() == viewer.state().loop->display().pixels();
    });
    EXPECT_EQ(viewer.x().place(), (std::array{0, 0, viewer.state().width, viewer.state().height}));
    viewer.x().press("F11");
    viewer.until("a window again", [&] {
      return !viewer.state().fullscreen && viewer.state().width == width && viewer.state().height == height;
    });
    EXPECT_EQ(viewer.x().place(), (std::array{37, 53, width, height})) << "where it was";
    viewer.untilConverged();
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowWalk, EscapeAndTheWindowManagerEndIt) {
  for (const bool byKey : {true, false}) {
    bool closed = false;
    const int status = DrivenViewer::run(drivenOptions(), [&](DrivenViewer& viewer) {
      viewer.untilOpen();
      if (byKey) {
        viewer.x().press("Escape");
      } else {
        viewer.x().close();
      }
      viewer.untilClosed();
      closed = true;
    });
    EXPECT_TRUE(closed) << byKey;
    EXPECT_EQ(status, 0) << byKey;
  }
}

TEST_F(WindowWalk, ItLeavesThePictureOfItsLastFrame) {
  app::WalkOptions options = drivenOptions();
  options.uiScreenshot = "ui.png";
  core::ImageRgba8 last;
  const int status = DrivenViewer::run(options, [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    last = viewer.picture();
    viewer.x().close();
    viewer.untilClosed();
  });
  EXPECT_EQ(status, 0);
  const core::ImageRgba8 file = core::readImage8("ui.png");
  EXPECT_EQ(file.width(), 640);
  EXPECT_EQ(file.height(), 800);
  EXPECT_EQ(crop(file, {0, 0, last.width(), last.height()}).pixels(), last.pixels());
}

TEST_F(WindowWalk, ItClosesByItself) {
  app::WalkOptions options = drivenOptions();
  options.exitAfterSeconds = 0.5;
  options.uiScreenshot = "ui.png";
  EXPECT_EQ(DrivenViewer::run(options, [&](DrivenViewer& viewer) { viewer.untilClosed(); }), 0);
  EXPECT_EQ(core::readImage8("ui.png").width(), 640);
}

}  // namespace
}  // namespace saccade::tests
