// What the base layer draws of a scene, found without OpenGL.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "render/base/features.h"

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

/// A mesh's place in the vertices of a layout and in the indices of all.
struct MeshPart {
  std::uint32_t mesh = 0;
  std::uint32_t attributes = 0;
  std::uint32_t firstVertex = 0;
  std::uint32_t firstIndex = 0;
};

struct DrawList {
  /// By layout, features, texture, material and id: neighbours share state. Objects without triangles are
  /// left out.
  std::vector<DrawItem> items;
  std::vector<MeshPart> parts;  ///< a mesh once for each layout that its objects need, sorted like `items`
  std::vector<SurfaceConstants> constants;  ///< by object
};

/// `scene` must be charted already (applyCharts) where maps will be shown. Throws core::Error for more
/// triangles than can be drawn. Any thread.
DrawList makeDrawList(const core::Scene& scene);

}  // namespace saccade::render
