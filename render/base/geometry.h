// The scene's triangles on the GL side, in draw order. GL thread only.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/scene/scene.h"
#include "render/base/features.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// An object and its mesh's part of the index buffer.
struct DrawItem {
  std::uint32_t object = 0;
  Features features = 0;         ///< with maps
  std::uint32_t attributes = 0;  ///< names the vertex layout
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  bool solid = false;      ///< opaque, and its front faces hide its back faces from outside
  bool instanced = false;  ///< vertices are in the mesh's space: Object::meshToWorld
  bool mirrored = false;   ///< and that turns triangles over
  bool oneSided = false;   ///< single-sided and opaque: its back faces are invisible to the camera
};

/// All meshes, an instanced one once for each layout that its objects need. Vertices interleaved, one vertex
/// buffer per layout (the attributes that programs need), and one index buffer sorted like `items`.
class Geometry {
 public:
  Geometry(const Gl& gl, const core::Scene& scene);

  /// By layout, features, texture, material and id: neighbours share state. Objects without triangles are
  /// left out.
  const std::vector<DrawItem>& items() const { return items_; }
  GLuint vertexArray(std::uint32_t attributes) const { return layouts_.at(attributes).vertexArray.name(); }

 private:
  struct Layout {
    GlVertexArray vertexArray;
    GlBuffer vertices;
  };
  void sortItems(const core::Scene& scene);
  void upload(const Gl& gl, const core::Scene& scene);

  std::vector<DrawItem> items_;
  GlBuffer indices_;
  std::map<std::uint32_t, Layout> layouts_;
};

}  // namespace saccade::render
