// Needs a display (scripts/test provides a virtual one); without it these tests skip themselves.
#include "render/window/window.h"

#include <imgui/imgui.h>

#include <cstdlib>

#include "core/error.h"
#include "render/base/base_renderer.h"
#include "render/window/imgui_layer.h"
#include "render/window/presenter.h"
#include "scene_fixture.h"

namespace saccade::tests {
namespace {

bool haveDisplay() { return std::getenv("DISPLAY") != nullptr; }
#define SACCADE_NEEDS_DISPLAY() \
  if (!haveDisplay()) GTEST_SKIP() << "no display (DISPLAY is unset): run under xvfb-run"

TEST(Window, WithoutDisplayTheErrorSaysWhatToDo) {
  const char* display = std::getenv("DISPLAY");
  const std::string kept = display ? display : "";
  unsetenv("DISPLAY");
  std::string text;
  try {
    render::Window window(64, 64, "none");
  } catch (const core::Error& error) {
    text = error.what();
  }
  if (display) setenv("DISPLAY", kept.c_str(), 1);
  EXPECT_NE(text.find("DISPLAY"), std::string::npos) << text;
  EXPECT_NE(text.find("--headless"), std::string::npos) << text;
}

TEST(Window, ShowsWhatIsPresentedUnderThePanel) {
  SACCADE_NEEDS_DISPLAY();
  render::Window window(200, 100, "saccade test");
  window.pollEvents();
  const int width = window.width(), height = window.height();
  ASSERT_GT(width, 0);
  core::ImageRgba8 image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 9, 255};
  }
  render::Presenter presenter(window.context());
  presenter.present(image, {0, 0, width, height}, width, height);
  EXPECT_EQ(window.screenshot().pixels(), image.pixels());

  render::ImguiLayer panel(window);
  for (int frame = 0; frame < 2; ++frame) {  // a new panel settles in its second frame
    panel.newFrame(width, height);
    ImGui::Begin("panel");
    ImGui::End();
    panel.render();
  }
  EXPECT_FALSE(window.screenshot().pixels() == image.pixels());
  window.swap();
}

TEST(Window, StatesCanBeSet) {
  SACCADE_NEEDS_DISPLAY();
  render::Window window(120, 90, "before");
  window.setTitle("after \xC3\xA9");
  window.setVsync(true);
  window.setMouseCaptured(true);
  EXPECT_TRUE(window.mouseCaptured());
  window.setMouseCaptured(false);
  EXPECT_FALSE(window.mouseCaptured());
  EXPECT_FALSE(window.isDown(render::Key::w));
  EXPECT_FALSE(window.isDown(render::MouseButton::left));
  EXPECT_FALSE(window.fullscreen());
  window.setFullscreen(true);
  EXPECT_TRUE(window.fullscreen());
  window.pollEvents();
  window.setFullscreen(false);
  EXPECT_FALSE(window.fullscreen());
}

TEST(Window, DrawsTheBaseLayerAsOffScreen) {
  SACCADE_NEEDS_DISPLAY();
  const core::Scene scene = oneQuad(lambert({0.5f, 0.25f, 1}), 4);
  const core::View view({}, 40, 30, scene.bounds);
  std::shared_ptr<core::FrameSnapshot> onScreen;
  std::string renderer;
  {
    render::Window window(64, 64, "base layer");
    renderer = window.context().renderer();
    onScreen = render::BaseRenderer(window.context(), scene).render(view, 1, 10);
  }
  const auto osmesa = render::makeHeadlessContext(render::ContextKind::osmesa);
  const auto offScreen = render::BaseRenderer(*osmesa, scene).render(view, 1, 10);
  EXPECT_EQ(onScreen->extents[4].box, offScreen->extents[4].box);
  if (renderer == osmesa->renderer()) {
    EXPECT_EQ(onScreen->baseAndId, offScreen->baseAndId);
  }
}

}  // namespace
}  // namespace saccade::tests
