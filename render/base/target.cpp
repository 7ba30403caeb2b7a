#include "render/base/target.h"

#include <string>

#include "core/error.h"

namespace saccade::render {

namespace {

GlTexture makeAttachment(const Gl& gl, GLenum internal, GLenum format, GLenum attachment, int width,
                         int height) {
  GlTexture texture(gl);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), width, height, 0, format, GL_FLOAT, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.name(), 0);
  return texture;
}

}  // namespace

void Target::resize(int width, int height) {
  width_ = height_ = 0;
  // The old attachments go first: two large ones at once may not fit.
  framebuffer_ = GlFramebuffer();
  color_ = GlTexture();
  depth_ = GlTexture();
  framebuffer_ = GlFramebuffer(gl_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  color_ = makeAttachment(gl_, GL_RGBA32F, GL_RGBA, GL_COLOR_ATTACHMENT0, width, height);
  depth_ = makeAttachment(gl_, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_DEPTH_ATTACHMENT, width, height);
  checkGl(gl_, ("making a target of " + std::to_string(width) + "x" + std::to_string(height)).c_str());
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw core::Error("this OpenGL context draws no RGBA32F image of " + std::to_string(width) + "x" +
                      std::to_string(height) +
                      " with float depth; try a smaller --size or another --context");
  }
  width_ = width;
  height_ = height;
}

void Target::begin(int width, int height) {
  if (width < 1 || height < 1 || width > maxSide_ || height > maxSide_) {
    throw core::Error("cannot draw " + std::to_string(width) + "x" + std::to_string(height) +
                      " pixels: this OpenGL context takes 1 to " + std::to_string(maxSide_) + " a side");
  }
  if (width != width_ || height != height_) resize(width, height);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  gl_.Viewport(0, 0, width, height);
}

void Target::read(core::FrameSnapshot& frame) const {
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
  frame.baseAndId.resize(pixels);
  frame.depth.resize(pixels);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, frame.baseAndId.data());
  gl_.ReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, frame.depth.data());
}

}  // namespace saccade::render
