// The charts of a scene and their places in a square atlas (see charts.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/maps.h"
#include "core/progress.h"
#include "core/scene/scene.h"
#include "raytrace/bake/chart_clusters.h"
#include "raytrace/bake/own_atlas.h"
#include "raytrace/bake/vertex_texels.h"

namespace saccade::raytrace {

/// What has a texel density of its own: a chart of a mesh that one object uses, all charts of an object
/// that shares its mesh, or of one that keeps its second UV set. All of a mesh lit by vertex is one, too.
struct LayoutItem {
  double rectangle = 0;      ///< m^2 that its charts' rectangles take; 0: lit by vertex
  double largestExtent = 0;  ///< m, of a chart
  double edge = 0;           ///< m, of a mesh lit by vertex: what its texels' side is, whatever is wished
};

/// Whether meshes may keep their light by vertex.
enum class VertexLight { never, whereItPays };

/// Not movable while others refer to it; const functions from any thread.
class ChartLayout {
 public:
  /// Cuts the meshes of a loaded, not yet charted scene, about a microsecond per triangle. `scene` must
  /// outlive it; it may be charted meanwhile. A second UV set that is a proper atlas (own_atlas.h) stays as
  /// it is, one rectangle that holds all charts of its mesh. `mostTexels`: that the atlas may have; to keep
  /// their gutters, meshes take up to half of it, each by its surface.
  ///
  /// A mesh keeps its light by vertex where that pays. It has core::kDenseVertices or more, and with all
  /// texels (`withBlocks`, at least mostTexels: those of detail blocks too) spread evenly its edges are
  /// mostly shorter than texels, and its charts fall to pieces: with borders they take half as many texels
  /// again as its surface would, and it has at most twice as many vertices. Such meshes take at most half of
  /// the atlas. Instanced meshes do not: their objects' blocks differ in scale.
  ///
  /// Progress is that in triangles. Throws core::Error soon after a stop was requested.
  explicit ChartLayout(const core::Scene& scene, double mostTexels = 1 << 20,
                       VertexLight vertexLight = VertexLight::never, double withBlocks = 0,
                       const core::Progress& progress = {});

  std::size_t chartCount() const { return count_ + (shared_ ? 1 : 0); }
  /// Of meshes that show irradiance.
  const AtlasCounts& ownAtlases() const { return ownAtlases_; }
  std::size_t vertexLitMeshes() const { return vertexLitMeshes_; }
  const std::vector<LayoutItem>& items() const { return items_; }
  /// Of an object that shows irradiance.
  std::size_t itemOf(std::size_t object, std::size_t triangle) const;

  /// Texels that all rectangles and their borders take; `texelMetres`: by item, > 0. Slow neither way: no
  /// packing.
  double texelCount(std::span<const double> texelMetres);
  /// Gives everything its place; false when size x size texels do not suffice.
  bool pack(std::span<const double> texelMetres, int size);

  /// For core::applyCharts, as packed last. Of a scene that is charted already only uv and places count.
  core::SceneCharts cut(int size) const;

 private:
  /// A rectangle of texels, its border included.
  struct Place {
    int width = 0, height = 0, x = 0, y = 0;
  };
  struct PlacedChart {
    Chart chart;
    Place place;                             ///< in the atlas, or in the block of an instanced mesh
    double coarsestTexel = core::kInfinity;  ///< m, in the mesh's space
    double edge = 0;                         ///< m; > 0: lit by vertex, `place` has its size
  };
  /// The charts of an instanced mesh, packed.
  struct Block {
    std::uint32_t mesh = 0;
    int width = 0, height = 0;
  };
  /// A lit object of an instanced mesh.
  struct PlacedBlock {
    std::size_t object = 0, block = 0;
    double unit = 0;  ///< metres in the world per unit of the mesh
    int scale = 1;    ///< texels a texel of the block takes, a power of two
    Place place;
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  bool isLit(const core::Object& object) const;
  void addObject(std::size_t o, std::vector<std::size_t>& blockOf, const std::stop_token& stop);
  void addInstance(std::size_t o, std::size_t& block, const std::stop_token& stop);
  void shareTexels(double mostTexels);
  std::vector<PlacedChart>& chartsOf(std::uint32_t mesh, const std::stop_token& stop);
  void keepAtlas(std::uint32_t mesh);
  bool lightByVertex(std::uint32_t mesh, const std::vector<Chart>& charts);
  void addItem(const std::vector<PlacedChart>& charts, std::size_t first, std::size_t last, double unit);
  void size(std::span<const double> texelMetres);
  bool packBlock(Block& block, int size);
  static bool packRects(const std::vector<Place*>& places, int width, int height);
  static core::Vec2 atlasUv(const PlacedChart& placed, const glm::dvec2& projected, int size);
  static core::MeshCharts cutMesh(const core::Mesh& mesh, const std::vector<PlacedChart>& charts, int size);
  static core::MeshCharts wholeMesh(const core::Mesh& mesh, std::vector<core::Vec2> uv);
  core::MeshCharts vertexLitMesh(std::uint32_t mesh, int size) const;
  core::MeshCharts keptMesh(std::uint32_t mesh, int size) const;

  const core::Scene& scene_;
  std::vector<std::vector<PlacedChart>> charts_;             ///< by mesh
  std::vector<std::vector<std::uint32_t>> chartOfTriangle_;  ///< by mesh
  std::vector<OwnAtlas> own_;                                ///< by mesh
  std::vector<VertexTexels> vertices_;                       ///< by mesh; empty: not lit by vertex
  std::vector<double> shares_;                               ///< by mesh: texels that an own atlas may take
  double mostTexels_, withBlocks_;
  VertexLight vertexLight_;
  std::size_t vertexLitMeshes_ = 0;
  double vertexTexelCount_ = 0;  ///< of their rectangles
  AtlasCounts ownAtlases_{};
  std::vector<LayoutItem> items_;
  std::vector<std::size_t> firstItem_;  ///< by object
  std::vector<std::uint32_t> order_;    ///< meshes in world space, in the order of their objects
  std::vector<std::size_t> orderItem_;  ///< their first items
  std::vector<Block> blocks_;
  std::vector<PlacedBlock> instances_;
  bool shared_ = false;  ///< some object shows no irradiance: all those share a texel
  Place sharedPlace_;
  std::size_t count_ = 0;
};

}  // namespace saccade::raytrace
