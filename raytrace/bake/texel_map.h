// Which surface each texel of the atlas holds: covered areas, exact at chart borders, and points on them.
//
// Texels of a mesh whose light is kept by vertex (core::Mesh::vertexLit) hold the points whose largest
// barycentric weight is that of their vertex: a third of each triangle around it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/math/types.h"
#include "core/scene/scene.h"
#include "raytrace/bake/cell_clip.h"

namespace saccade::raytrace {

/// The part of one triangle that lies in one texel.
struct TexelFragment {
  std::uint32_t object = 0, triangle = 0;  ///< triangle of the object's mesh
  float area = 0;                          ///< m^2 in the world
};

/// A chart's own texels: [x0, x1) x [y0, y1), gutter not included.
struct ChartRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool doubleSided = false;  ///< its back has its own irradiance, in layer 1
  bool byVertex = false;     ///< a texel for each vertex of a mesh: texels side by side are no neighbours
};

/// Chart number of each triangle, from 0: triangles are of one chart when they share a vertex or a place in
/// the atlas. `uvs`: one per vertex. Charts are found from the uv alone so that maps read from a file need no
/// list of them.
std::vector<std::int32_t> chartsOfUv(const core::Mesh& mesh, std::span<const core::Vec2> uvs);

/// The part of a texel that holds surface.
struct TexelCover {
  Plane2 centroid{0};  ///< in the atlas, in texels
  double share = 0;    ///< of the texel
};

/// One of the columns x rows cells that a texel is cut into; the whole texel.
struct TexelCell {
  int columns = 1, rows = 1, x = 0, y = 0;
  bool whole() const { return columns == 1 && rows == 1; }
  /// Keeps the random numbers of cells apart: 0 for the whole texel; even, the last bit is for the layer.
  std::uint32_t number() const {
    return whole() ? 0 : static_cast<std::uint32_t>(((columns + x) << 16) + ((rows + y) << 1));
  }
};

/// A point of a charted mesh.
struct MeshPoint {
  std::uint32_t object = 0, triangle = 0;
  float b1 = 0, b2 = 0;  ///< barycentric weights of corners 1 and 2
};

/// Built once from a charted scene (core::applyCharts called); read-only afterwards, any thread.
class TexelMap {
 public:
  /// Objects that show no irradiance have no texels. Throws core::Error when a mesh carries no lightmapUv.
  TexelMap(const core::Scene& charted, int size);

  const core::Scene& scene() const { return scene_; }
  int size() const { return size_; }
  std::size_t texelCount() const { return static_cast<std::size_t>(size_) * size_; }
  const std::vector<ChartRect>& charts() const { return charts_; }
  /// Index into charts(), or -1 where the texel holds no surface.
  std::int32_t chartOf(std::size_t texel) const { return chartOf_[texel]; }
  /// World area in m^2 that the texel covers: the exact area of the triangles clipped to it, so that flux /
  /// area is unbiased in texels that a chart's border cuts. Slivers below a thousandth of a texel are left
  /// out.
  float area(std::size_t texel) const { return area_[texel]; }
  std::span<const TexelFragment> fragments(std::size_t texel) const {
    return {fragments_.data() + first_[texel], fragments_.data() + first_[texel + 1]};
  }
  /// Exact, from the clipped triangles. The texel must hold some and not be a vertex's.
  TexelCover coverOf(std::size_t texel) const;
  /// A point spread evenly over the texel's covered area for (u, v, w) in [0, 1)^3. The texel must hold some.
  MeshPoint pointOn(std::size_t texel, float u, float v, float w) const;
  /// Of a mesh lit by vertex: of the vertex at mesh.indices[corner].
  std::uint32_t vertexTexel(std::size_t object, std::size_t corner) const;
  /// The point at a position of the atlas, in texels, that lies in the texel; none where no surface is.
  std::optional<MeshPoint> pointAt(std::size_t texel, const Plane2& position) const;
  /// The point at u in [0, 1)^2 of a cell of the texel; none where no surface is.
  std::optional<MeshPoint> pointIn(std::size_t texel, const TexelCell& cell, const core::Vec2& u) const {
    const Plane2 place = (Plane2(cell.x, cell.y) + Plane2(u)) / Plane2(cell.columns, cell.rows);
    return pointAt(texel, cornerOf(texel) + place);
  }
  /// Its corner in the atlas, in texels.
  Plane2 cornerOf(std::size_t texel) const {
    const std::size_t size = static_cast<std::size_t>(size_), row = texel / size;
    return {static_cast<double>(texel % size), static_cast<double>(row)};
  }
  /// The texel that a point of a charted mesh lies in.
  std::size_t texelAt(const core::Vec2& lightmapUv) const;
  /// A layer for backs is needed.
  bool anyDoubleSided() const { return anyDoubleSided_; }

 private:
  struct Placed {
    std::uint32_t texel;
    std::int32_t chart;
    float cells;  ///< share of the texel
    TexelFragment fragment;
  };
  void findCharts();
  std::vector<Placed> placeFragments() const;
  void placeByVertex(std::size_t object, std::size_t triangle, double area, std::vector<Placed>& out) const;
  MeshPoint pointByVertex(const TexelFragment& part, std::size_t texel, float v, float w) const;
  CellPolygon clipped(const TexelFragment& fragment, std::size_t texel) const;
  void cover();

  const core::Scene& scene_;
  int size_;
  bool anyDoubleSided_ = false;
  static constexpr std::int32_t kNoCharts = -1;
  std::vector<std::vector<std::int32_t>> chartOfTriangle_;  ///< by mesh, from 0
  std::vector<std::int32_t> firstChart_;                    ///< by object, added to these; or kNoCharts
  std::vector<ChartRect> charts_;
  std::vector<std::int32_t> chartOf_;
  std::vector<float> area_;
  std::vector<std::size_t> first_;
  std::vector<TexelFragment> fragments_;
};

}  // namespace saccade::raytrace
