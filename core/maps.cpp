#include "core/maps.h"

#include <algorithm>

#include "core/cache_folder.h"
#include "core/content_hash.h"
#include "core/math/half.h"
#include "core/scene/mesh_repair.h"

namespace saccade::core {
namespace {

void checkCounts(const Scene& scene, const SceneCharts& charts) {
  if (charts.meshes.size() == scene.meshes.size() && charts.places.size() == scene.objects.size()) return;
  throw Error(scene.path + ": the charts are for " + std::to_string(charts.meshes.size()) + " meshes and " +
              std::to_string(charts.places.size()) + " objects, the scene has " +
              std::to_string(scene.meshes.size()) + " and " + std::to_string(scene.objects.size()));
}

}  // namespace

Vec3 IlluminationMaps::texel(int x, int y, int layer) const {
  const auto column = static_cast<std::size_t>(std::clamp(x, 0, width - 1));
  const auto row = static_cast<std::size_t>(std::clamp(y, 0, height - 1));
  const auto plane = static_cast<std::size_t>(std::clamp(layer, 0, layers - 1));
  const std::size_t at =
      ((plane * static_cast<std::size_t>(height) + row) * static_cast<std::size_t>(width) + column) * 3;
  return Vec3(fromHalf(texels[at]), fromHalf(texels[at + 1]), fromHalf(texels[at + 2]));
}

std::size_t IlluminationMaps::lightBytes() const {
  return (texels.size() + detail.texels.size()) * sizeof(std::uint16_t) +
         detail.blocks.size() * sizeof(std::uint32_t);
}

void applyCharts(Scene& scene, const SceneCharts& charts) {
  checkCounts(scene, charts);
  for (std::size_t m = 0; m < charts.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    const MeshCharts& c = charts.meshes[m];
    const bool fits = c.indices.size() == mesh.indices.size() && c.uv.size() == c.sourceVertex.size() &&
                      std::all_of(c.sourceVertex.begin(), c.sourceVertex.end(),
                                  [&](std::uint32_t v) { return v < mesh.positions.size(); });
    if (!fits) throw Error(scene.path + ": the charts of mesh " + std::to_string(m) + " do not fit it");
    mesh = gatherVertices(mesh, c.sourceVertex);
    mesh.vertexLit = c.perVertex;
    mesh.indices = c.indices;
  }
  placeCharts(scene, charts);
}

void placeCharts(Scene& scene, const SceneCharts& charts) {
  checkCounts(scene, charts);
  for (std::size_t m = 0; m < charts.meshes.size(); ++m) {
    if (charts.meshes[m].uv.size() != scene.meshes[m].positions.size())
      throw Error(scene.path + ": the charts of mesh " + std::to_string(m) + " do not fit it");
    scene.meshes[m].lightmapUv = charts.meshes[m].uv;
  }
  for (std::size_t o = 0; o < charts.places.size(); ++o)
    scene.objects[o].lightmapScaleOffset = charts.places[o];
}

std::uint64_t contentHash(const IlluminationMaps& maps) {
  ContentHash hash;
  for (const int number : {maps.width, maps.height, maps.layers, maps.detail.height}) hash.add(number);
  hash.addArray(maps.texels);
  hash.addArray(maps.detail.blocks);
  hash.addArray(maps.detail.texels);
  hash.addArray(maps.charts.places);
  for (const MeshCharts& mesh : maps.charts.meshes) {
    hash.add(mesh.perVertex);
    hash.addArray(mesh.sourceVertex);
    hash.addArray(mesh.uv);
    hash.addArray(mesh.indices);
  }
  return hash.value();
}

std::filesystem::path defaultMapsPath(std::uint64_t key, const std::string& settings) {
  ContentHash hash;
  hash.add(key);
  hash.add(settings);
  return cacheFolder() / (cacheName(hash.value()) + ".maps");
}

}  // namespace saccade::core
