// The scene's triangles on the GL side. GL thread only.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "core/scene/scene.h"
#include "render/base/draw_list.h"
#include "render/base/portions.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// Vertices interleaved, one vertex buffer per layout (the attributes that programs need), and one index
/// buffer.
class Geometry {
 public:
  /// Adds the upload of `parts` (DrawList) to the portions; all of them, the scene and this object must be
  /// where they are until those are done.
  void addUpload(const Gl& gl, const core::Scene& scene, std::span<const MeshPart> parts, Portions& portions);

  GLuint vertexArray(std::uint32_t attributes) const { return layouts_.at(attributes).vertexArray.name(); }

 private:
  struct Layout {
    GlVertexArray vertexArray;
    GlBuffer vertices;
  };
  void makeBuffers(const Gl& gl, const core::Scene& scene, std::span<const MeshPart> parts);

  GlBuffer indices_;
  std::map<std::uint32_t, Layout> layouts_;
};

}  // namespace saccade::render
