// Owners of GL names. They die on the GL thread while their context is current.
#pragma once

#include <utility>

#include "render/context/gl.h"

namespace saccade::render {

enum class GlKind { buffer, vertexArray, texture, framebuffer, program };

template <GlKind kind>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(const Gl& gl) : gl_(&gl) {
    static_assert(kind != GlKind::program, "a program comes from buildProgram");
    if constexpr (kind == GlKind::buffer) gl.GenBuffers(1, &name_);
    if constexpr (kind == GlKind::vertexArray) gl.GenVertexArrays(1, &name_);
    if constexpr (kind == GlKind::texture) gl.GenTextures(1, &name_);
    if constexpr (kind == GlKind::framebuffer) gl.GenFramebuffers(1, &name_);
  }
  /// Takes over an existing name.
  GlObject(const Gl& gl, GLuint name) : gl_(&gl), name_(name) {}
  GlObject(GlObject&& o) noexcept : gl_(o.gl_), name_(std::exchange(o.name_, 0)) {}
  GlObject& operator=(GlObject&& o) noexcept {
    std::swap(gl_, o.gl_);
    std::swap(name_, o.name_);
    return *this;
  }
  ~GlObject() {
    if (name_ == 0) return;
    if constexpr (kind == GlKind::buffer) gl_->DeleteBuffers(1, &name_);
    if constexpr (kind == GlKind::vertexArray) gl_->DeleteVertexArrays(1, &name_);
    if constexpr (kind == GlKind::texture) gl_->DeleteTextures(1, &name_);
    if constexpr (kind == GlKind::framebuffer) gl_->DeleteFramebuffers(1, &name_);
    if constexpr (kind == GlKind::program) gl_->DeleteProgram(name_);
  }
  GLuint name() const { return name_; }

 private:
  const Gl* gl_ = nullptr;
  GLuint name_ = 0;
};

using GlBuffer = GlObject<GlKind::buffer>;
using GlVertexArray = GlObject<GlKind::vertexArray>;
using GlTexture = GlObject<GlKind::texture>;
using GlFramebuffer = GlObject<GlKind::framebuffer>;
using GlProgram = GlObject<GlKind::program>;

}  // namespace saccade::render
