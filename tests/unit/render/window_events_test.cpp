// Real events, sent by another client of the display, arrive as the documented Event; and what was drawn is
// what the screen shows.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "render/window/presenter.h"
#include "render/window/window.h"
#include "scene_fixture.h"
#include "tests/x_driver.h"

namespace saccade::tests {
namespace {

using namespace std::chrono_literals;
using render::Key;
using render::MouseButton;

constexpr std::chrono::seconds kPatience{60};

/// A window with somebody at it, and all that it reported.
class WindowEvents : public ::testing::Test {
 protected:
  void SetUp() override {
    SACCADE_NEEDS_A_DISPLAY_TO_DRIVE();
    window_.emplace(320, 200, "saccade events");
    driver_.emplace("saccade events");
    driver_->placeAt(100, 50);
    settle();
  }

  void poll() {
    for (const render::Event& event : window_->pollEvents()) events_.push_back(event);
  }
  /// Events that came before the test's own, such as the pointer entering.
  void settle() {
    for (int i = 0; i < 10; ++i) {
      poll();
      std::this_thread::sleep_for(10ms);
    }
    events_.clear();
  }
  bool waitFor(const std::function<bool()>& done) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (poll(); !done(); poll()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(5ms);
    }
    return true;
  }
  template <class E>
  std::vector<E> all() const {
    std::vector<E> found;
    for (const render::Event& event : events_) {
      if (const E* e = std::get_if<E>(&event)) found.push_back(*e);
    }
    return found;
  }
  template <class E>
  bool waitForCount(std::size_t count) {
    return waitFor([&] { return all<E>().size() >= count; });
  }

  XDriver& driver() { return *driver_; }
  render::Window& window() { return *window_; }

  std::vector<render::Event> events_;

 private:
  std::optional<render::Window> window_;
  std::optional<XDriver> driver_;
};

TEST_F(WindowEvents, KeysArriveByPositionPressedAndReleased) {
  const std::vector<std::pair<std::string, Key>> keys{{"w", Key::w},          {"a", Key::a},
                                                      {"0", Key::digit0},     {"5", Key::digit5},
                                                      {"F1", Key::f1},        {"F12", Key::f12},
                                                      {"Left", Key::left},    {"Up", Key::up},
                                                      {"Home", Key::home},    {"Prior", Key::pageUp},
                                                      {"Tab", Key::tab},      {"Escape", Key::escape},
                                                      {"space", Key::space},  {"Control_R", Key::control},
                                                      {"Alt_L", Key::alt},    {"KP_Enter", Key::enter},
                                                      {"minus", Key::minus},  {"equal", Key::plus},
                                                      {"Delete", Key::remove}};
  for (const auto& [name, key] : keys) {
    events_.clear();
    driver().keyDown(name);
    ASSERT_TRUE(waitForCount<render::KeyEvent>(1)) << name;
    EXPECT_TRUE(window().isDown(key)) << name;
    driver().keyUp(name);
    ASSERT_TRUE(waitFor([this, k = key] { return !window().isDown(k); })) << name;
    const auto got = all<render::KeyEvent>();
    ASSERT_GE(got.size(), 2u) << name;
    EXPECT_EQ(got.front().key, key) << name;
    EXPECT_TRUE(got.front().pressed && !got.front().repeat) << name;
    EXPECT_EQ(got.back().key, key) << name;
    EXPECT_FALSE(got.back().pressed || got.back().repeat) << name;
  }
}

TEST_F(WindowEvents, AKeyHeldDownRepeatsAndStaysDown) {
  driver().keyDown("d");
  const bool repeated = waitForCount<render::KeyEvent>(3);
  EXPECT_TRUE(window().isDown(Key::d));
  driver().keyUp("d");
  ASSERT_TRUE(repeated) << "the server repeats no keys";
  ASSERT_TRUE(waitFor([&] { return !window().isDown(Key::d); }));
  const auto got = all<render::KeyEvent>();
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].key, Key::d);
    EXPECT_EQ(got[i].pressed, i + 1 < got.size()) << i;
    EXPECT_EQ(got[i].repeat, i > 0 && i + 1 < got.size()) << i;
  }
}

TEST_F(WindowEvents, AModifierIsAKeyDownBesideTheOther) {
  driver().keyDown("Shift_L");
  driver().keyDown("w");
  ASSERT_TRUE(waitForCount<render::KeyEvent>(2));
  EXPECT_TRUE(window().isDown(Key::shift) && window().isDown(Key::w));
  driver().keyUp("Shift_L");
  ASSERT_TRUE(waitFor([&] { return !window().isDown(Key::shift); }));
  EXPECT_TRUE(window().isDown(Key::w));
  driver().keyUp("w");
  ASSERT_TRUE(waitFor([&] { return !window().isDown(Key::w); }));
}

TEST_F(WindowEvents, TheMouseHasAPlaceAndMovesByTheDifference) {
  driver().moveTo(40, 30);
  ASSERT_TRUE(waitForCount<render::MouseMoveEvent>(1));
  events_.clear();
  driver().moveTo(45, 28);
  driver().moveTo(60, 90);
  ASSERT_TRUE(waitFor([&] {
    const auto got = all<render::MouseMoveEvent>();
    return !got.empty() && got.back().positionPx == core::Vec2(60, 90);
  }));
  core::Vec2 sum(0);
  for (const auto& move : all<render::MouseMoveEvent>()) sum += move.deltaPx;
  EXPECT_EQ(sum, core::Vec2(20, 60));
}

TEST_F(WindowEvents, ButtonsArriveWhereTheyWerePressed) {
  const std::vector<std::pair<int, MouseButton>> buttons{
      {1, MouseButton::left}, {2, MouseButton::middle}, {3, MouseButton::right}};
  for (const auto& [number, button] : buttons) {
    events_.clear();
    driver().moveTo(10 * number, 20 * number);
    driver().buttonDown(number);
    ASSERT_TRUE(waitForCount<render::MouseButtonEvent>(1)) << number;
    EXPECT_TRUE(window().isDown(button));
    driver().buttonUp(number);
    ASSERT_TRUE(waitForCount<render::MouseButtonEvent>(2)) << number;
    EXPECT_FALSE(window().isDown(button));
    const auto got = all<render::MouseButtonEvent>();
    EXPECT_TRUE(got[0].button == button && got[0].pressed) << number;
    EXPECT_TRUE(got[1].button == button && !got[1].pressed) << number;
    EXPECT_EQ(got[0].positionPx, core::Vec2(10 * number, 20 * number));
  }
}

TEST_F(WindowEvents, TheWheelCountsSteps) {
  driver().moveTo(100, 100);
  settle();
  driver().wheel(3);
  ASSERT_TRUE(waitForCount<render::ScrollEvent>(3));
  driver().wheel(-1);
  ASSERT_TRUE(waitForCount<render::ScrollEvent>(4));
  const auto got = all<render::ScrollEvent>();
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i].amount, core::Vec2(0, i < 3 ? 1 : -1)) << i;
}

TEST_F(WindowEvents, ACapturedMouseMovesWithoutBounds) {
  driver().moveTo(160, 100);
  settle();
  window().setMouseCaptured(true);
  settle();
  // Ten times the window's width to the right: no edge stops it.
  for (int i = 0; i < 40; ++i) {
    driver().moveBy(80, 0);
    poll();
  }
  const auto sum = [&] {
    core::Vec2 total(0);
    for (const auto& move : all<render::MouseMoveEvent>()) total += move.deltaPx;
    return total;
  };
  // The first event after the capture starts anew (the pointer jumped), so it counts for nothing.
  EXPECT_TRUE(waitFor([&] { return sum().x >= 39 * 80; })) << sum().x;
  EXPECT_LE(sum().x, 40 * 80);
  EXPECT_EQ(sum().y, 0);
  EXPECT_GT(all<render::MouseMoveEvent>().back().positionPx.x, static_cast<float>(window().width()));
  window().setMouseCaptured(false);
}

TEST_F(WindowEvents, AResizeSaysTheFramebuffersSize) {
  for (const auto& [width, height] : {std::pair{500, 300}, {150, 401}, {64, 64}}) {
    events_.clear();
    driver().resize(width, height);
    ASSERT_TRUE(waitForCount<render::ResizeEvent>(1)) << width;
    const auto last = all<render::ResizeEvent>().back();
    EXPECT_EQ(last.width, width);
    EXPECT_EQ(last.height, height);
    EXPECT_EQ(window().width(), width);
    EXPECT_EQ(window().height(), height);
  }
}

TEST_F(WindowEvents, TheWindowManagersButtonAsksToClose) {
  driver().close();
  ASSERT_TRUE(waitForCount<render::CloseEvent>(1));
}

TEST_F(WindowEvents, FilesDroppedByAnotherProgramArriveByTheirNames) {
  const std::vector<std::filesystem::path> files{"/tmp/a room/My Scene 100%.glb",
                                                 "/tmp/Stra\xC3\x9F"
                                                 "e/\xE6\xA3\xAE#1.gltf"};
  driver().beginDrop(files, 160, 100);
  ASSERT_TRUE(waitFor([&] { return driver().drop() == Drop::accepted; }));
  const auto got = all<render::DropEvent>();
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].files, files);
}

TEST_F(WindowEvents, TheScreenShowsWhatWasPresented) {
  render::Presenter presenter(window().context());
  for (const auto& [w, h] : {std::pair{320, 200}, {411, 123}}) {
    const int width = w, height = h;
    driver().resize(width, height);
    ASSERT_TRUE(waitFor([&] { return window().width() == width && window().height() == height; }));
    core::ImageRgba8 image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                          static_cast<std::uint8_t>(width), 255};
      }
    }
    EXPECT_TRUE(waitFor([&] {
      window().bind();
      presenter.present(image, {0, 0, width, height}, width, height);
      window().swap();
      return driver().screen().pixels() == image.pixels();
    })) << width
        << "x" << height;
  }
}

TEST_F(WindowEvents, FullScreenFillsTheDisplayAndGoesBack) {
  window().setFullscreen(true);
  ASSERT_TRUE(waitForCount<render::ResizeEvent>(1));
  const auto full = all<render::ResizeEvent>().back();
  EXPECT_EQ(full.width, driver().screen().width());
  EXPECT_EQ(full.height, driver().screen().height());
  EXPECT_GT(full.width, 320);
  window().setFullscreen(false);
  EXPECT_TRUE(waitFor([&] { return window().width() == 320 && window().height() == 200; }));
}

}  // namespace
}  // namespace saccade::tests
