// What the base layer is drawn into, and how it comes back. GL thread only.
#pragma once

#include "core/corrective/messages.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// RGBA32F colour and 32-bit float depth of any size up to the context's.
class Target {
 public:
  Target(const Gl& gl, int maxSide) : gl_(gl), maxSide_(maxSide) {}

  /// Binds, after making the size fit; the viewport covers it. Throws core::Error.
  void begin(int width, int height);
  /// Reads colour and depth into the snapshot, row 0 first. The target is bound.
  void read(core::FrameSnapshot& frame) const;

 private:
  void resize(int width, int height);

  const Gl& gl_;
  int maxSide_;
  int width_ = 0, height_ = 0;
  GlFramebuffer framebuffer_;
  GlTexture color_, depth_;
};

}  // namespace saccade::render
