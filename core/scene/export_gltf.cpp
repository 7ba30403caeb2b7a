#include "core/scene/export_gltf.h"

#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <span>

#include "core/scene/export_materials.h"
#include "core/scene/glb_builder.h"
#include "core/scene/instances.h"
#include "core/scene/placement.h"

namespace saccade::core {
namespace {

using nlohmann::json;

std::vector<Vec2> atlasUvs(const Scene& scene, const Object& object) {
  std::vector<Vec2> out;
  for (const Vec2& uv : scene.meshOf(object).lightmapUv)
    out.push_back(placeInAtlas(object.lightmapScaleOffset, uv));
  return out;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Clusters of one primitive become one again, as the file had it.
bool sameAccessors(const Scene& scene, const Object& a, const Object& b) {
  const Mesh &m = scene.meshOf(a), &n = scene.meshOf(b);
  return a.primitive == b.primitive && a.material == b.material && !m.instanced && !n.instanced &&
         m.tangents.empty() == n.tangents.empty() && m.uv0.empty() == n.uv0.empty() &&
         m.uv1.empty() == n.uv1.empty() && m.colors.empty() == n.colors.empty();
}

Mesh merged(const Scene& scene, std::span<const Object> objects) {
  Mesh out;
  for (const Object& o : objects) {
    const Mesh& m = scene.meshOf(o);
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    append(out.positions, m.positions);
    append(out.normals, m.normals);
    append(out.tangents, m.tangents);
    append(out.uv0, m.uv0);
    append(out.uv1, m.uv1);
    append(out.colors, m.colors);
    append(out.lightmapUv, atlasUvs(scene, o));
    for (const std::uint32_t i : m.indices) out.indices.push_back(first + i);
  }
  return out;
}

class SceneExporter {
 public:
  SceneExporter(const Scene& scene, GlbBuilder& glb) : scene_(scene), glb_(glb) {}

  void addObjects() {
    const std::span<const Object> all = scene_.objects;
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
      for (last = first + 1; last < all.size() && all[last].node == all[first].node && all[first].node >= 0;)
        ++last;
      addNodeOf(all.subspan(first, last - first));
    }
  }

  void addCameras() {
    constexpr double kNearShare = 1e-4, kFarShare = 10;  // of the scene's diagonal
    const double diagonal =
        std::max(1e-3, static_cast<double>(glm::length(scene_.bounds.hi - scene_.bounds.lo)));
    for (const Camera& camera : scene_.cameras) {
      const Vec3 forward = glm::normalize(camera.at - camera.eye);
      const bool level = glm::length(glm::cross(forward, camera.up)) > 1e-6f * glm::length(camera.up);
      const glm::quat q = glm::quatLookAt(forward, level ? camera.up : Vec3(0, 0, 1));
      glb_.root["cameras"].push_back({{"name", camera.name},
                                      {"type", "perspective"},
                                      {"perspective",
                                       {{"yfov", glm::radians(static_cast<double>(camera.fovYDegrees))},
                                        {"znear", kNearShare * diagonal},
                                        {"zfar", kFarShare * diagonal}}}});
      addRoot(addNode({{"name", camera.name},
                       {"camera", glb_.root["cameras"].size() - 1},
                       {"translation", jsonArray(camera.eye)},
                       {"rotation", jsonArray(Vec4(q.x, q.y, q.z, q.w))}}));
    }
  }

  void finish() {
    glb_.root["scenes"] = json::array({{{"nodes", roots_}}});
    glb_.root["scene"] = 0;
  }

 private:
  /// Objects of one node, or one without.
  void addNodeOf(std::span<const Object> objects) {
    const int node = objects.front().node;
    const Mat4 toWorld = node < 0 ? Mat4(1) : scene_.nodes[static_cast<std::size_t>(node)].localToWorld;
    if (node >= 0 && isInstanceable(toWorld)) {
      const int at = treeNode(node);
      glb_.root["nodes"][static_cast<std::size_t>(at)]["mesh"] = addMesh(objects, toWorld);
      return;
    }
    // Without a transform that can be undone the world's coordinates are left.
    const std::string& name =
        node < 0 ? objects.front().name : scene_.nodes[static_cast<std::size_t>(node)].name;
    addRoot(addNode({{"name", name}, {"mesh", addMesh(objects, Mat4(1))}}));
  }

  /// The node and those above it.
  int treeNode(int node) {
    const auto [at, isNew] = nodes_.try_emplace(node, 0);
    if (!isNew) return at->second;
    const Node& from = scene_.nodes[static_cast<std::size_t>(node)];
    json out = {{"name", from.name}};
    if (from.localToParent != Mat4(1)) {
      json& matrix = out["matrix"];
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) matrix.push_back(static_cast<double>(from.localToParent[c][r]));
    }
    const int index = addNode(std::move(out));
    at->second = index;
    if (from.parent < 0) {
      addRoot(index);
    } else {
      const int parent = treeNode(from.parent);
      glb_.root["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
    }
    return index;
  }

  int addNode(json node) {
    glb_.root["nodes"].push_back(std::move(node));
    return static_cast<int>(glb_.root["nodes"].size()) - 1;
  }
  void addRoot(int node) { roots_.push_back(node); }

  int addMesh(std::span<const Object> objects, const Mat4& meshToWorld) {
    json primitives = json::array();
    for (std::size_t first = 0, last = 0; first < objects.size(); first = last) {
      for (last = first + 1; last < objects.size() && sameAccessors(scene_, objects[first], objects[last]);)
        ++last;
      const Object& o = objects[first];
      json primitive = scene_.meshOf(o).instanced
                           ? instance(o)
                           : ownGeometry(objects.subspan(first, last - first), meshToWorld);
      primitive["material"] = o.material;
      primitives.push_back(std::move(primitive));
    }
    glb_.root["meshes"].push_back({{"primitives", std::move(primitives)}});
    return static_cast<int>(glb_.root["meshes"].size()) - 1;
  }

  json ownGeometry(std::span<const Object> objects, const Mat4& meshToWorld) {
    Mesh mesh = merged(scene_, objects);
    if (meshToWorld != Mat4(1)) bakeIntoWorld(mesh, Mat4(glm::inverse(glm::dmat4(meshToWorld))));
    json primitive = geometry(mesh, materialOf(objects.front()));
    addAtlas(primitive, mesh.lightmapUv);
    return primitive;
  }

  json instance(const Object& object) {
    const ExportedUvSets sets = exportedUvSets(materialOf(object));
    const auto [at, isNew] = instanced_.try_emplace({object.mesh, sets.of0});
    if (isNew) at->second = geometry(scene_.meshOf(object), materialOf(object));
    json primitive = at->second;
    addAtlas(primitive, atlasUvs(scene_, object));
    return primitive;
  }

  /// All but the places in the atlas.
  json geometry(const Mesh& mesh, const Material& material) {
    json attributes = {{"POSITION", glb_.addPositions(mesh.positions)},
                       {"NORMAL", glb_.addNormals(mesh.normals)}};
    if (!mesh.tangents.empty()) attributes["TANGENT"] = glb_.addVec4s(mesh.tangents);
    if (!mesh.colors.empty()) attributes["COLOR_0"] = glb_.addVec4s(mesh.colors);
    const ExportedUvSets sets = exportedUvSets(material);
    const auto addUvs = [&](int set, const std::vector<Vec2>& uv) {
      if (!uv.empty()) attributes["TEXCOORD_" + std::to_string(set)] = glb_.addUvs(uv);
    };
    addUvs(sets.of0, mesh.uv0);
    addUvs(sets.of1, mesh.uv1);
    return {{"attributes", std::move(attributes)},
            {"indices", glb_.addIndices(mesh.indices, mesh.positions.size())}};
  }

  void addAtlas(json& primitive, const std::vector<Vec2>& uv) {
    json& attributes = primitive["attributes"];
    const int accessor = glb_.addUvs(uv);
    attributes["TEXCOORD_1"] = accessor;
    if (!attributes.contains("TEXCOORD_0")) attributes["TEXCOORD_0"] = accessor;
  }

  const Material& materialOf(const Object& object) const {
    return scene_.materials[static_cast<std::size_t>(object.material)];
  }

  const Scene& scene_;
  GlbBuilder& glb_;
  json roots_ = json::array();
  std::map<int, int> nodes_;                                 ///< scene node -> glTF node
  std::map<std::pair<std::uint32_t, int>, json> instanced_;  ///< (mesh, UV layout) -> primitive
};

}  // namespace

std::vector<std::uint8_t> exportGltf(const Scene& charted, const LightTextures& light) {
  GlbBuilder glb;
  MaterialExporter(charted, light, glb).addAll();
  SceneExporter scene(charted, glb);
  scene.addObjects();
  scene.addCameras();
  scene.finish();
  return glb.bytes("Saccade");
}

}  // namespace saccade::core
