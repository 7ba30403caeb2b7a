#include "render/base/draw_list.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/scene/placement.h"
#include "render/base/solid.h"

namespace saccade::render {

namespace {

/// Asked once a mesh: the answer holds in any place, mirrored ones included.
class Solids {
 public:
  explicit Solids(const core::Scene& scene) : scene_(scene), known_(scene.meshes.size(), kUnknown) {}
  bool isSolid(const core::Object& object) {
    const bool opaque = scene_.materials[object.material].alphaMode == core::AlphaMode::opaque;
    if (!opaque || !object.closed) return false;
    char& known = known_[object.mesh];
    if (known == kUnknown) known = isOutwardSolid(scene_.meshOf(object));
    return known == 1;
  }

 private:
  static constexpr char kUnknown = 2;
  const core::Scene& scene_;
  std::vector<char> known_;
};

/// As the tracer has it: what refracts is seen from inside too.
bool isOneSided(const core::Material& material) {
  return !material.doubleSided && material.transmission == 0;
}

std::vector<DrawItem> makeItems(const core::Scene& scene) {
  std::vector<DrawItem> items;
  Solids solids(scene);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const core::Object& object = scene.objects[i];
    const core::Mesh& mesh = scene.meshOf(object);
    if (mesh.indices.empty()) continue;
    DrawItem item;
    item.object = i;
    item.features = featuresOf(scene, object);
    item.attributes = attributesOf(item.features);
    item.indexCount = static_cast<std::uint32_t>(mesh.indices.size());
    item.solid = solids.isSolid(object);
    item.oneSided = isOneSided(scene.materials[object.material]);
    item.instanced = mesh.instanced;
    item.mirrored = mesh.instanced && core::Placement(object.meshToWorld).mirrored;
    items.push_back(item);
  }
  return items;
}

void sortItems(const core::Scene& scene, std::vector<DrawItem>& items) {
  std::sort(items.begin(), items.end(), [&](const DrawItem& a, const DrawItem& b) {
    const auto key = [&](const DrawItem& item) {
      const core::Object& o = scene.objects[item.object];
      return std::tuple(item.attributes, item.features, scene.materials[o.material].baseColorTexture.texture,
                        o.material, o.id, item.object);
    };
    return key(a) < key(b);
  });
}

/// Gives every mesh its place, and every item its mesh's.
std::vector<MeshPart> placeMeshes(const core::Scene& scene, std::vector<DrawItem>& items) {
  constexpr std::size_t kLimit = std::numeric_limits<std::uint32_t>::max() / sizeof(std::uint32_t);
  std::vector<MeshPart> parts;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> firstIndices;  // of mesh and attributes
  std::map<std::uint32_t, std::size_t> vertices;                                  // by attributes
  std::size_t indices = 0;
  for (DrawItem& item : items) {
    const std::uint32_t index = scene.objects[item.object].mesh;
    const auto [known, isNew] =
        firstIndices.try_emplace({index, item.attributes}, static_cast<std::uint32_t>(indices));
    item.firstIndex = known->second;
    if (!isNew) continue;
    const core::Mesh& mesh = scene.meshes[index];
    std::size_t& vertexCount = vertices[item.attributes];
    if (indices + mesh.indices.size() > kLimit || vertexCount + mesh.positions.size() > kLimit)
      throw core::Error("the scene has too many triangles; at most " + std::to_string(kLimit / 3) +
                        " can be drawn");
    parts.push_back({index, item.attributes, static_cast<std::uint32_t>(vertexCount), item.firstIndex});
    vertexCount += mesh.positions.size();
    indices += mesh.indices.size();
  }
  return parts;
}

}  // namespace

DrawList makeDrawList(const core::Scene& scene) {
  DrawList list;
  list.items = makeItems(scene);
  sortItems(scene, list.items);
  list.parts = placeMeshes(scene, list.items);
  list.constants.reserve(scene.objects.size());
  for (const core::Object& object : scene.objects) list.constants.push_back(constantsOf(scene, object));
  return list;
}

}  // namespace saccade::render
