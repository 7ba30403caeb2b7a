// A window with an OpenGL 4.5 core context, and its input as plain values: no GLFW or GL type leaves render/.
// Main thread only (GLFW's rule), the destructor included. One window at a time.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/image.h"
#include "core/math/types.h"
#include "render/context/gl_context.h"

struct GLFWwindow;

namespace saccade::render {

/// Keys by position on a US keyboard, so that WASD stays a cross. Left and right modifiers are one key.
// clang-format off
enum class Key : std::uint8_t {
  unknown,
  a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
  digit0, digit1, digit2, digit3, digit4, digit5, digit6, digit7, digit8, digit9,
  f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
  left, right, up, down, pageUp, pageDown, home, end,
  space, shift, control, alt, escape, enter, tab, backspace, remove, plus, minus,
  count
};
// clang-format on

enum class MouseButton : std::uint8_t { left, right, middle };

struct KeyEvent {
  Key key;
  bool pressed;  ///< else released
  bool repeat;   ///< held down: pressed again by the keyboard's repeat
};
struct MouseButtonEvent {
  MouseButton button;
  bool pressed;
  core::Vec2 positionPx;  ///< framebuffer pixels, y down
};
struct MouseMoveEvent {
  core::Vec2 positionPx;  ///< framebuffer pixels, y down; without bounds while captured
  core::Vec2 deltaPx;     ///< since the last move
};
struct ScrollEvent {
  core::Vec2 amount;  ///< steps of the wheel; y > 0 is away from the user
};
struct ResizeEvent {
  int width, height;  ///< framebuffer pixels; 0x0 while minimised
};
struct CloseEvent {};
struct DropEvent {
  std::vector<std::filesystem::path> files;
};
using Event =
    std::variant<KeyEvent, MouseButtonEvent, MouseMoveEvent, ScrollEvent, ResizeEvent, CloseEvent, DropEvent>;

/// How much larger than usual letters should be for the main display, in [0.5, 4]: 1 at about 96 dots an
/// inch. While there is no window: how large one must be may depend on it. Throws core::Error as Window does.
float displayScale();

class Window {
 public:
  /// Framebuffer of about this size in pixels; current on the calling thread. Throws core::Error saying what
  /// to do where there is no display or no OpenGL 4.5.
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GlContext& context();

  /// What happened since the last call, in order; waits for nothing. Input that Dear ImGui wants is reported
  /// too: ask ImGui::GetIO().WantCaptureMouse / WantCaptureKeyboard.
  std::vector<Event> pollEvents();
  bool isDown(Key key) const;
  bool isDown(MouseButton button) const;

  int width() const;   ///< framebuffer pixels
  int height() const;  ///< framebuffer pixels
  void setTitle(const std::string& title);
  /// Swap waits for the display's refresh; off at first (the frame loop has its own clock).
  void setVsync(bool on);
  /// Hides the pointer and reports unbounded motion (mouse-look).
  void setMouseCaptured(bool captured);
  bool mouseCaptured() const;
  void setFullscreen(bool on);
  bool fullscreen() const;
  /// {width, height} that the constructor makes a window of this size from; while full screen the one that
  /// comes back.
  std::array<int, 2> windowedSize() const;
  /// Draws go to the window until another framebuffer is bound.
  void bind();
  /// Shows what was drawn.
  void swap();
  /// What was drawn since the last swap, row 0 = top, alpha 255. Call before swap.
  core::ImageRgba8 screenshot();

  GLFWwindow* handle();  ///< for ImguiLayer

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::render
