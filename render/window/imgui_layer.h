// Dear ImGui over what was presented. The application describes its panel with imgui.h between newFrame and
// render; input comes from GLFW (the library's backend), drawing goes through the context's own functions:
// the library's OpenGL backend opens libGL by itself, which OSMesa cannot use.
#pragma once

#include <memory>

#include "render/context/gl_context.h"
#include "render/window/window.h"

namespace saccade::render {

/// GL thread only, the destructor included. One at a time: Dear ImGui's state is global.
class ImguiLayer {
 public:
  /// On a window: create it after the window's first use of events or before, both work; destroy it first.
  /// `scale`: of letters and all that is measured by them, > 0.
  explicit ImguiLayer(Window& window, float scale = 1);
  /// Off screen, without input.
  explicit ImguiLayer(GlContext& context);
  ~ImguiLayer();

  /// Starts a frame of the given framebuffer size in pixels. ImGui calls are allowed from here to render.
  /// `deltaSeconds` is used off screen only (> 0); a window has its own clock.
  void newFrame(int framebufferWidth, int framebufferHeight, float deltaSeconds = 1.0f / 60);
  /// Draws into the framebuffer bound now. Throws core::Error on GL errors.
  void render();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::render
