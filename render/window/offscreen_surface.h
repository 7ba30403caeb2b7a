// Stands in for the window's framebuffer where there is no window: the same presenter and panel draw into it.
#pragma once

#include <memory>

#include "core/image.h"
#include "render/context/gl_context.h"

namespace saccade::render {

/// GL thread only, the destructor included.
class OffscreenSurface {
 public:
  /// RGBA8, pixels. Throws core::Error: empty, beyond the context's limits.
  OffscreenSurface(GlContext& context, int width, int height);
  ~OffscreenSurface();

  /// Draws go here until another framebuffer is bound.
  void bind();
  int width() const;
  int height() const;
  /// Row 0 = top, alpha 255.
  core::ImageRgba8 read();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::render
