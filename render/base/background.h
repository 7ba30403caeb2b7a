// The environment behind the scene: a pass over the whole image at the far plane. GL thread only.
#pragma once

#include "core/camera.h"
#include "core/scene/scene.h"
#include "render/base/portions.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// Looks radiance up as core::environmentRadiance does, with the same bilinear filter; textures wider or
/// higher than the context takes are averaged down to fit.
class Background {
 public:
  /// Adds its upload to the portions; it and the environment must stay where they are until those are done.
  Background(const Gl& gl, const core::Environment& environment, int maxSide, Portions& portions);

  /// Writes radiance and ID 0 where the depth buffer still holds 0. Expects the base layer's target bound,
  /// with the viewport over all of it; leaves texture unit 0, program and vertex array changed.
  void draw(const core::View& view) const;

 private:
  void makeProgram(float rotation);
  void makeTexture(int width, int height);

  const Gl& gl_;
  core::ImageRgb smaller_;  ///< to upload in place of the environment's; empty: that fits
  GlTexture texture_;
  GlProgram program_;
  GlVertexArray noAttributes_;
  GLint corner_ = -1, turns_ = -1;
};

}  // namespace saccade::render
