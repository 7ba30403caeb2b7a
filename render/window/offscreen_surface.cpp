#include "render/window/offscreen_surface.h"

#include <string>

#include "core/error.h"
#include "render/context/gl_object.h"
#include "render/window/read_pixels.h"

namespace saccade::render {

struct OffscreenSurface::State {
  State(GlContext& glContext, int w, int h)
      : context(glContext), gl(glContext.gl()), framebuffer(gl), color(gl), width(w), height(h) {}
  GlContext& context;
  const Gl& gl;
  GlFramebuffer framebuffer;
  GlTexture color;
  int width, height;
};

OffscreenSurface::OffscreenSurface(GlContext& context, int width, int height) {
  if (width < 1 || height < 1 || width > context.maxSize() || height > context.maxSize()) {
    throw core::Error("cannot draw " + std::to_string(width) + "x" + std::to_string(height) +
                      " pixels: this OpenGL context takes 1 to " + std::to_string(context.maxSize()) +
                      " a side");
  }
  context.makeCurrent();
  state_ = std::make_unique<State>(context, width, height);
  const Gl& gl = state_->gl;
  gl.BindTexture(GL_TEXTURE_2D, state_->color.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  bind();
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, state_->color.name(), 0);
  checkGl(gl, "making an off-screen surface");
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw core::Error("this OpenGL context cannot draw into an RGBA8 image; try another --context");
  }
}
OffscreenSurface::~OffscreenSurface() { state_->context.makeCurrent(); }

void OffscreenSurface::bind() {
  state_->context.makeCurrent();
  state_->gl.BindFramebuffer(GL_FRAMEBUFFER, state_->framebuffer.name());
}
int OffscreenSurface::width() const { return state_->width; }
int OffscreenSurface::height() const { return state_->height; }

core::ImageRgba8 OffscreenSurface::read() {
  bind();
  core::ImageRgba8 image = readRgba8(state_->gl, state_->width, state_->height);
  checkGl(state_->gl, "reading an off-screen surface");
  return image;
}

}  // namespace saccade::render
