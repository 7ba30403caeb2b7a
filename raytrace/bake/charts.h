// Cutting a scene into charts and packing them into one square atlas for the illumination maps (Haber 2001,
// section 4: illumination maps stored as textures).
//
// A chart is a connected set of triangles whose normals lie within 40 degrees of its axis, projected along
// the axis, so areas shrink by at most a quarter (a few triangles where charts meet lie within 52: by four
// tenths). Charts are stretched to whole texels (a chart's rectangle side is rounded), so that straight walls
// end at a texel's border and no texel is covered by a sliver only.
//
// A mesh whose second UV set is a proper atlas (own_atlas.h) keeps that instead, as one rectangle.
//
// A dense, crumpled mesh may keep its light by vertex instead (ChartLayout).
//
// An instanced mesh is cut once; its charts are packed into a block, and each object has such a block in the
// atlas, larger by a power of two where the object is larger.
#pragma once

#include <cstddef>
#include <vector>

#include "core/maps.h"
#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "raytrace/bake/own_atlas.h"

namespace saccade::raytrace {

struct ChartAtlas {
  core::SceneCharts charts;  ///< hand them to core::applyCharts
  int size = 0;              ///< atlas side in texels
  /// Side of a texel on a surface parallel to its chart. On instances within a factor of sqrt(2): their sizes
  /// count as powers of two times that of the smallest with the same mesh.
  float texelMetres = 0;
  std::size_t chartCount = 0;       ///< an atlas that a mesh brings counts as one
  AtlasCounts ownAtlases{};         ///< meshes that bring one, and the others by reason
  std::size_t vertexLitMeshes = 0;  ///< by chartByLight only
};

/// Whether the base layer ever shows irradiance on this material: it has a Lambert part. Metals, clear glass,
/// black and unlit materials have none; their objects share one texel.
bool showsIrradiance(const core::Material& material);

/// Charts for every mesh of a loaded, not yet charted scene; uniform texel density from the total surface
/// area, in an atlas of plan.lightmapSize (0: 1024) texels. Between
/// charts lie two empty texels. The atlas doubles, up to maxAtlasSize, when its charts are so many that they
/// would cost more than half of the density. Deterministic; about a microsecond per triangle and core. Throws
/// core::Error when even one texel a chart does not fit maxAtlasSize.
ChartAtlas makeCharts(const core::Scene& scene, const core::Plan& plan, int maxAtlasSize);

}  // namespace saccade::raytrace
