#include "render/window/presenter.h"

#include <algorithm>
#include <cstdint>

#include "render/context/gl_object.h"

namespace saccade::render {

namespace {

// One strip over the viewport; texture row 0 is the image's top row.
constexpr const char* kVertex = R"(#version 330 core
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0);
}
)";
constexpr const char* kFragment = R"(#version 330 core
in vec2 uv;
out vec4 color;
uniform sampler2D image;
void main() { color = vec4(texture(image, uv).rgb, 1.0); }
)";

}  // namespace

PixelRect letterbox(const PixelRect& area, int imageWidth, int imageHeight) {
  if (area.width < 1 || area.height < 1 || imageWidth < 1 || imageHeight < 1) return {area.x, area.y, 0, 0};
  PixelRect fit = area;
  const std::int64_t wide = std::int64_t{area.width} * imageHeight,
                     tall = std::int64_t{area.height} * imageWidth;
  if (wide > tall) {
    fit.width = std::max(1, static_cast<int>(tall / imageHeight));
  } else {
    fit.height = std::max(1, static_cast<int>(wide / imageWidth));
  }
  fit.x += (area.width - fit.width) / 2;
  fit.y += (area.height - fit.height) / 2;
  return fit;
}

struct Presenter::State {
  explicit State(GlContext& glContext)
      : context(glContext),
        gl(glContext.gl()),
        program(gl, buildProgram(gl, "presenter", kVertex, kFragment)),
        texture(gl),
        vertexArray(gl) {}

  GlContext& context;
  const Gl& gl;
  GlProgram program;
  GlTexture texture;
  GlVertexArray vertexArray;
  int width = 0, height = 0;  ///< of the texture

  void upload(const core::ImageRgba8& image);
  void drawQuad(const PixelRect& at, bool oneToOne, int framebufferHeight);
};

void Presenter::State::upload(const core::ImageRgba8& image) {
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const void* texels = image.pixels().data();
  if (image.width() == width && image.height() == height) {
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    return;
  }
  width = image.width();
  height = image.height();
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void Presenter::State::drawQuad(const PixelRect& at, bool oneToOne, int framebufferHeight) {
  const GLint filter = oneToOne ? GL_NEAREST : GL_LINEAR;
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.Viewport(at.x, framebufferHeight - at.y - at.height, at.width, at.height);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(program.name());
  gl.BindVertexArray(vertexArray.name());
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.BindVertexArray(0);
}

Presenter::Presenter(GlContext& context) {
  context.makeCurrent();
  state_ = std::make_unique<State>(context);
}
Presenter::~Presenter() { state_->context.makeCurrent(); }

void Presenter::present(const core::ImageRgba8& image, const PixelRect& area, int framebufferWidth,
                        int framebufferHeight) {
  if (framebufferWidth < 1 || framebufferHeight < 1) return;
  state_->context.makeCurrent();
  const Gl& gl = state_->gl;
  gl.Disable(GL_BLEND);
  gl.Disable(GL_SCISSOR_TEST);
  constexpr float kBlack[4] = {0, 0, 0, 1};
  gl.ClearBufferfv(GL_COLOR, 0, kBlack);
  const PixelRect at = letterbox(area, image.width(), image.height());
  if (at.width > 0) {
    state_->upload(image);
    state_->drawQuad(at, at.width == image.width() && at.height == image.height(), framebufferHeight);
  }
  checkGl(gl, "presenting a frame");
}

}  // namespace saccade::render
