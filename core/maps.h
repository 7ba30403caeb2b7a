// Illumination maps: irradiance (no albedo) in an atlas, RGB half float; layer 0 the front side, layer 1 the
// back of double-sided surfaces (present only when the scene has any). One file; written to a temporary name
// and renamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/map_detail.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// Of the file, and of what bakes make of a scene: files of another version are refused.
inline constexpr std::uint32_t kMapsVersion = 4;

/// How a mesh is cut into charts: its vertices are duplicated along chart borders.
struct MeshCharts {
  std::vector<std::uint32_t> sourceVertex;  ///< new vertex -> vertex of the loaded mesh
  std::vector<Vec2> uv;                     ///< per new vertex: Mesh::lightmapUv
  std::vector<std::uint32_t> indices;       ///< 3 per triangle, same triangle order as the loaded mesh
  bool perVertex = false;                   ///< Mesh::vertexLit
};

/// All of a scene: the charts of an instanced mesh are cut once, and each of its objects has a block of the
/// atlas with the same layout.
struct SceneCharts {
  std::vector<MeshCharts> meshes;  ///< one per mesh of the scene
  std::vector<Vec4> places;        ///< one per object: Object::lightmapScaleOffset
};

struct IlluminationMaps {
  int width = 0, height = 0, layers = 0;
  std::vector<std::uint16_t> texels;  ///< IEEE half, 3 per texel: ((layer * height + y) * width + x) * 3
  MapDetail detail;                   ///< finer texels where light steps
  SceneCharts charts;
  std::string quality;  ///< preview, medium, high
  std::uint64_t photons = 0;
  std::uint64_t key = 0;  ///< sceneKey of the scene they were made for
  /// What halves could not hold when the maps were baked (known to the baker alone: not in the file).
  std::uint64_t clampedTexels = 0;
  double clampedWatts = 0;  ///< mean of R, G and B

  /// Decoded texel; x, y clamped to the atlas.
  Vec3 texel(int x, int y, int layer) const;
  /// Memory of what look-ups read: texels and detail; without the charts.
  std::size_t lightBytes() const;
};

/// Cuts the scene's meshes as the charts say, fills lightmapUv and places the objects. Call once, before
/// building Embree or GL scenes. Throws core::Error when charts and scene do not fit together.
void applyCharts(Scene& scene, const SceneCharts& charts);

/// Moves the charts of a scene that is cut already to other places: takes uv and places only. The same charts
/// otherwise. Throws core::Error when charts and scene do not fit together. See World::refreshCharts.
void placeCharts(Scene& scene, const SceneCharts& charts);

/// Hash of all that the maps depend on: geometry, materials, textures, lights, and the format's version.
std::uint64_t sceneKey(const Scene& scene);

/// Hash of all that look-ups in maps and their charts read.
std::uint64_t contentHash(const IlluminationMaps& maps);

/// $XDG_CACHE_HOME/saccade/<hash>.maps (or ~/.cache). `settings` tells quality, photons and seed apart.
std::filesystem::path defaultMapsPath(std::uint64_t key, const std::string& settings);

/// Throws core::Error: wrong magic, version, key (when `key` != 0), counts that overflow or a truncated file.
IlluminationMaps readMaps(const std::filesystem::path& file, std::uint64_t key);
void writeMaps(const std::filesystem::path& file, const IlluminationMaps& maps);

}  // namespace saccade::core
