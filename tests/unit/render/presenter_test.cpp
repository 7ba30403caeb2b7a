#include "render/window/presenter.h"

#include <imgui/imgui.h>

#include "core/error.h"
#include "render/window/imgui_layer.h"
#include "render/window/offscreen_surface.h"
#include "scene_fixture.h"

namespace saccade::tests {
namespace {

using core::ImageRgba8;
using core::Rgba8;
using render::PixelRect;

class Present : public EachContext {};
SACCADE_EACH_CONTEXT(Present);

/// Every pixel its own colour.
ImageRgba8 gradient(int width, int height) {
  ImageRgba8 image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(3 * x), static_cast<std::uint8_t>(5 * y), 77, 255};
    }
  }
  return image;
}

TEST(Letterbox, KeepsTheShapeAndCentres) {
  EXPECT_EQ(render::letterbox({0, 0, 40, 30}, 40, 30), (PixelRect{0, 0, 40, 30}));
  EXPECT_EQ(render::letterbox({5, 7, 100, 50}, 10, 10), (PixelRect{30, 7, 50, 50}));
  EXPECT_EQ(render::letterbox({0, 0, 50, 100}, 10, 10), (PixelRect{0, 25, 50, 50}));
  EXPECT_EQ(render::letterbox({0, 0, 20000, 1}, 1, 16384), (PixelRect{9999, 0, 1, 1}));
  EXPECT_EQ(render::letterbox({3, 4, 0, 9}, 10, 10).width, 0);
  EXPECT_EQ(render::letterbox({3, 4, 9, 9}, 0, 10).width, 0);
}

TEST_P(Present, OneToOneIsExactAndTheTopStaysUp) {
  const ImageRgba8 image = gradient(17, 9);
  render::OffscreenSurface surface(*context_, 17, 9);
  render::Presenter(*context_).present(image, {0, 0, 17, 9}, 17, 9);
  EXPECT_EQ(surface.read().pixels(), image.pixels());
}

TEST_P(Present, AreaIsMeasuredFromTheTopLeft) {
  const ImageRgba8 image = gradient(6, 4);
  render::OffscreenSurface surface(*context_, 20, 15);
  render::Presenter(*context_).present(image, {3, 2, 6, 4}, 20, 15);
  const ImageRgba8 shown = surface.read();
  for (int y = 0; y < 15; ++y) {
    for (int x = 0; x < 20; ++x) {
      const bool inside = x >= 3 && x < 9 && y >= 2 && y < 6;
      EXPECT_EQ(shown.at(x, y), (inside ? image.at(x - 3, y - 2) : Rgba8{0, 0, 0, 255})) << x << ", " << y;
    }
  }
}

TEST_P(Present, ScalesWithBarsAndFollowsNewSizes) {
  render::OffscreenSurface surface(*context_, 40, 20);
  render::Presenter presenter(*context_);
  for (const int side : {3, 8, 64}) {
    presenter.present(ImageRgba8(side, side, {200, 100, 50, 255}), {0, 0, 40, 20}, 40, 20);
    const ImageRgba8 shown = surface.read();
    EXPECT_EQ(shown.at(9, 10), (Rgba8{0, 0, 0, 255}));
    EXPECT_EQ(shown.at(10, 0), (Rgba8{200, 100, 50, 255}));
    EXPECT_EQ(shown.at(29, 19), (Rgba8{200, 100, 50, 255}));
    EXPECT_EQ(shown.at(30, 10), (Rgba8{0, 0, 0, 255}));
  }
}

TEST_P(Present, NothingToShowIsBlackAndNoFramebufferIsFine) {
  render::OffscreenSurface surface(*context_, 4, 4);
  render::Presenter presenter(*context_);
  presenter.present(ImageRgba8(), {0, 0, 4, 4}, 4, 4);
  EXPECT_EQ(surface.read().pixels(), ImageRgba8(4, 4, {0, 0, 0, 255}).pixels());
  EXPECT_NO_THROW(presenter.present(gradient(4, 4), {0, 0, 0, 0}, 0, 0));
}

TEST_P(Present, SurfaceBeyondTheLimitIsRefused) {
  EXPECT_THROW(render::OffscreenSurface(*context_, 0, 4), core::Error);
  EXPECT_THROW(render::OffscreenSurface(*context_, context_->maxSize() + 1, 4), core::Error);
}

TEST_P(Present, PanelCoversItsPlaceOnly) {
  const ImageRgba8 picture(320, 200, {10, 200, 30, 255});
  render::OffscreenSurface surface(*context_, 320, 200);
  render::Presenter presenter(*context_);
  render::ImguiLayer panel(*context_);
  ImageRgba8 shown;
  for (int frame = 0; frame < 2; ++frame) {  // a new window settles in its second frame
    surface.bind();
    presenter.present(picture, {0, 0, 320, 200}, 320, 200);
    panel.newFrame(320, 200);
    ImGui::SetNextWindowPos({200, 0});
    ImGui::SetNextWindowSize({120, 120});
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoSavedSettings);
    ImGui::Text("attention");
    ImGui::End();
    panel.render();
    shown = surface.read();
  }
  int changedInside = 0, changedOutside = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 320; ++x) {
      const bool changed = !(shown.at(x, y) == picture.at(x, y));
      (x >= 200 && y < 120 ? changedInside : changedOutside) += changed;
    }
  }
  EXPECT_GT(changedInside, 100 * 100);
  EXPECT_EQ(changedOutside, 0);
}

}  // namespace
}  // namespace saccade::tests
