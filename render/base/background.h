// The environment behind the scene: a pass over the whole image at the far plane. GL thread only.
#pragma once

#include "core/camera.h"
#include "core/scene/scene.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// Looks radiance up as core::environmentRadiance does, with the same bilinear filter; textures wider or
/// higher than the context takes are averaged down to fit.
class Background {
 public:
  Background(const Gl& gl, const core::Environment& environment, int maxSide);

  /// Writes radiance and ID 0 where the depth buffer still holds 0. Expects the base layer's target bound,
  /// with the viewport over all of it; leaves texture unit 0, program and vertex array changed.
  void draw(const core::View& view) const;

 private:
  const Gl& gl_;
  GlTexture texture_;
  GlProgram program_;
  GlVertexArray noAttributes_;
  GLint corner_ = -1, turns_ = -1;
};

}  // namespace saccade::render
