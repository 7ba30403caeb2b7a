#include "render/window/imgui_layer.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/context/gl_object.h"

namespace saccade::render {

namespace {

constexpr const char* kVertex = R"(#version 330 core
layout(location = 0) in vec2 positionIn;
layout(location = 1) in vec2 uvIn;
layout(location = 2) in vec4 colorIn;
uniform vec4 toClip;  // scale, offset
out vec2 uv;
out vec4 color;
void main() {
  uv = uvIn;
  color = colorIn;
  gl_Position = vec4(positionIn * toClip.xy + toClip.zw, 0.0, 1.0);
}
)";
constexpr const char* kFragment = R"(#version 330 core
in vec2 uv;
in vec4 color;
out vec4 result;
uniform sampler2D atlas;
void main() { result = color * texture(atlas, uv); }
)";

}  // namespace

struct ImguiLayer::State {
  State(GlContext& glContext, Window* onWindow, float scale);
  ~State();

  GlContext& context;
  const Gl& gl;
  Window* window;  ///< null off screen
  GlProgram program;
  GLint toClip;
  GlTexture atlas;
  GlVertexArray vertexArray;
  GlBuffer vertices, indices;

  void uploadAtlas();
  void describeVertices();
  void setDrawState(const ImDrawData& data);
  void drawList(const ImDrawList& list, const ImDrawData& data);
};

constexpr float kLetterHeight = 13;  ///< pixels at scale 1, that of the library's font

ImguiLayer::State::State(GlContext& glContext, Window* onWindow, float scale)
    : context(glContext),
      gl(glContext.gl()),
      window(onWindow),
      program(gl, buildProgram(gl, "panel", kVertex, kFragment)),
      toClip(gl.GetUniformLocation(program.name(), "toClip")),
      atlas(gl),
      vertexArray(gl),
      vertices(gl),
      indices(gl) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is written beside the user's files
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.BackendRendererName = "saccade";
  ImFontConfig font;
  font.SizePixels = std::round(kLetterHeight * scale);  // drawn at its size, not stretched
  io.Fonts->AddFontDefault(&font);
  ImGui::GetStyle().ScaleAllSizes(scale);
  uploadAtlas();
  describeVertices();
  if (window) ImGui_ImplGlfw_InitForOpenGL(window->handle(), true);
  checkGl(gl, "making the panel");
}

ImguiLayer::State::~State() {
  if (window) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ImguiLayer::State::uploadAtlas() {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  unsigned char* texels = nullptr;
  int width = 0, height = 0;
  fonts.GetTexDataAsRGBA32(&texels, &width, &height);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, atlas.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  fonts.SetTexID(reinterpret_cast<ImTextureID>(std::uintptr_t{atlas.name()}));
}

void ImguiLayer::State::describeVertices() {
  gl.BindVertexArray(vertexArray.name());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices.name());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
  const auto attribute = [&](GLuint location, GLint size, GLenum type, GLboolean normalized,
                             std::size_t offset) {
    gl.EnableVertexAttribArray(location);
    gl.VertexAttribPointer(location, size, type, normalized, sizeof(ImDrawVert),
                           reinterpret_cast<const void*>(offset));
  };
  attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
  gl.BindVertexArray(0);
}

void ImguiLayer::State::setDrawState(const ImDrawData& data) {
  gl.Viewport(0, 0, static_cast<GLsizei>(data.DisplaySize.x * data.FramebufferScale.x),
              static_cast<GLsizei>(data.DisplaySize.y * data.FramebufferScale.y));
  gl.Enable(GL_BLEND);
  gl.BlendEquation(GL_FUNC_ADD);
  gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_DEPTH_TEST);
  gl.Enable(GL_SCISSOR_TEST);
  gl.UseProgram(program.name());
  const float scaleX = 2 / data.DisplaySize.x, scaleY = -2 / data.DisplaySize.y;
  const std::array<float, 4> clip{scaleX, scaleY, -1 - data.DisplayPos.x * scaleX,
                                  1 - data.DisplayPos.y * scaleY};
  gl.Uniform4fv(toClip, 1, clip.data());
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindVertexArray(vertexArray.name());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices.name());
}

void ImguiLayer::State::drawList(const ImDrawList& list, const ImDrawData& data) {
  gl.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
  const ImVec2 scale = data.FramebufferScale;
  const float heightPx = data.DisplaySize.y * scale.y;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const float x0 = (command.ClipRect.x - data.DisplayPos.x) * scale.x;
    const float y0 = (command.ClipRect.y - data.DisplayPos.y) * scale.y;
    const float x1 = (command.ClipRect.z - data.DisplayPos.x) * scale.x;
    const float y1 = (command.ClipRect.w - data.DisplayPos.y) * scale.y;
    if (x1 <= x0 || y1 <= y0) continue;
    gl.Scissor(static_cast<GLint>(x0), static_cast<GLint>(heightPx - y1), static_cast<GLsizei>(x1 - x0),
               static_cast<GLsizei>(y1 - y0));
    gl.BindTexture(GL_TEXTURE_2D, static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())));
    gl.DrawElementsBaseVertex(
        GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
        sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(std::size_t{command.IdxOffset} * sizeof(ImDrawIdx)),
        static_cast<GLint>(command.VtxOffset));
  }
}

ImguiLayer::ImguiLayer(Window& window, float scale) {
  window.context().makeCurrent();
  state_ = std::make_unique<State>(window.context(), &window, scale);
}
ImguiLayer::ImguiLayer(GlContext& context) {
  context.makeCurrent();
  state_ = std::make_unique<State>(context, nullptr, 1.0f);
}
ImguiLayer::~ImguiLayer() { state_->context.makeCurrent(); }

void ImguiLayer::newFrame(int framebufferWidth, int framebufferHeight, float deltaSeconds) {
  if (state_->window) {
    ImGui_ImplGlfw_NewFrame();
  } else {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(framebufferWidth), static_cast<float>(framebufferHeight)};
    io.DeltaTime = deltaSeconds;
  }
  ImGui::NewFrame();
}

void ImguiLayer::render() {
  ImGui::Render();
  const ImDrawData& data = *ImGui::GetDrawData();
  if (data.DisplaySize.x <= 0 || data.DisplaySize.y <= 0) return;
  state_->context.makeCurrent();
  state_->setDrawState(data);
  for (int i = 0; i < data.CmdListsCount; ++i) state_->drawList(*data.CmdLists[i], data);
  state_->gl.BindVertexArray(0);
  state_->gl.Disable(GL_SCISSOR_TEST);
  state_->gl.Disable(GL_BLEND);
  checkGl(state_->gl, "drawing the panel");
}

}  // namespace saccade::render
