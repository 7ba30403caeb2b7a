#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>

#include "core/scene/gltf_accessors.h"
#include "core/scene/gltf_animation.h"
#include "core/scene/gltf_gate.h"
#include "core/scene/gltf_materials.h"
#include "core/scene/instances.h"
#include "core/scene/loaders.h"
#include "core/scene/tangents.h"

namespace saccade::core {
namespace {

// ---- tinygltf behind the gate

bool bufferExists(const std::string& name, void*) { return name.starts_with("buffer"); }
std::string bufferName(const std::string& name, void*) { return name; }
bool readBuffer(std::vector<unsigned char>* out, std::string* error, const std::string& name, void* user) {
  auto& buffers = *static_cast<std::vector<std::vector<std::uint8_t>>*>(user);
  const std::size_t index = std::strtoul(name.c_str() + std::strlen("buffer"), nullptr, 10);
  if (index >= buffers.size()) {
    *error = "no such buffer";
    return false;
  }
  *out = std::move(buffers[index]);  // each is asked for once
  return true;
}
bool writeNothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

tinygltf::Model parse(GatedGltf& gated, const std::string& who) {
  if (gated.json.size() > std::numeric_limits<unsigned>::max())
    throw Error(who + ": its JSON is longer than the parser counts");
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({&bufferExists, &bufferName, &readBuffer, &writeNothing, &gated.buffers});
  tinygltf::Model model;
  std::string error, warning;
  if (!parser.LoadASCIIFromString(&model, &error, &warning, gated.json.data(),
                                  static_cast<unsigned>(gated.json.size()), "", tinygltf::REQUIRE_VERSION)) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw Error(who + ": " + error);
  }
  return model;
}

// ---- nodes

Mat4 localMatrix(const tinygltf::Node& node, int& zeroRotations) {
  if (node.matrix.size() == 16) return Mat4(glm::make_mat4(node.matrix.data()));
  Mat4 m(1);
  if (node.translation.size() == 3) m[3] = Vec4(glm::make_vec3(node.translation.data()), 1);
  if (node.rotation.size() == 4) {
    const auto& q = node.rotation;
    const glm::dquat rotation(q[3], q[0], q[1], q[2]);
    const double length = glm::length(rotation);
    if (length > 0 && std::isfinite(length)) {
      m *= glm::mat4_cast(glm::quat(rotation / length));
    } else {
      ++zeroRotations;
    }
  }
  if (node.scale.size() == 3) {
    const Vec3 scale = glm::make_vec3(node.scale.data());
    for (int c = 0; c < 3; ++c) m[c] *= scale[c];
  }
  return m;
}

/// Nodes index for index, unit scale folded into the roots, and the indices of the chosen scene's nodes,
/// parents first.
std::vector<int> convertNodes(const tinygltf::Model& model, const LoadOptions& options, Scene& scene) {
  const int count = static_cast<int>(model.nodes.size());
  scene.nodes.resize(model.nodes.size());
  int zeroRotations = 0;
  for (int i = 0; i < count; ++i) {
    const tinygltf::Node& from = model.nodes[static_cast<std::size_t>(i)];
    Node& to = scene.nodes[static_cast<std::size_t>(i)];
    to.name = from.name.empty() ? std::string("node ").append(std::to_string(i)) : from.name;
    to.localToParent = localMatrix(from, zeroRotations);
    for (const int child : from.children) scene.nodes[static_cast<std::size_t>(child)].parent = i;
  }
  if (zeroRotations > 0)
    scene.warnings.push_back(std::to_string(zeroRotations) +
                             " node rotations of length 0 were taken as none");

  std::vector<int> order;
  if (model.scenes.empty()) {
    for (int i = 0; i < count; ++i)
      if (scene.nodes[static_cast<std::size_t>(i)].parent < 0) order.push_back(i);
  } else {
    const int wanted = options.scene >= 0 ? options.scene : std::max(0, model.defaultScene);
    if (wanted >= static_cast<int>(model.scenes.size()))
      throw Error(scene.path + ": has no scene " + std::to_string(wanted) + "; choose --scene 0 to " +
                  std::to_string(model.scenes.size() - 1));
    order = model.scenes[static_cast<std::size_t>(wanted)].nodes;
  }
  const Mat4 unit(Mat3(options.unitScale));
  for (Node& node : scene.nodes)
    if (node.parent < 0) node.localToParent = unit * node.localToParent;
  for (std::size_t at = 0; at < order.size(); ++at) {
    Node& node = scene.nodes[static_cast<std::size_t>(order[at])];
    node.localToWorld = node.parent < 0 ? node.localToParent
                                        : scene.nodes[static_cast<std::size_t>(node.parent)].localToWorld *
                                              node.localToParent;
    const auto& children = model.nodes[static_cast<std::size_t>(order[at])].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  std::sort(order.begin(), order.end());
  return order;
}

// ---- meshes

Mesh localMesh(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  Mesh mesh;
  const auto attribute = [&](const char* name) {
    const auto at = primitive.attributes.find(name);
    return at == primitive.attributes.end() ? -1 : at->second;
  };
  mesh.positions = readVec3(model, attribute("POSITION"));
  if (const int a = attribute("NORMAL"); a >= 0) mesh.normals = readVec3(model, a);
  if (const int a = attribute("TANGENT"); a >= 0) mesh.tangents = readVec4(model, a);
  if (const int a = attribute("TEXCOORD_0"); a >= 0) mesh.uv0 = readVec2(model, a);
  if (const int a = attribute("TEXCOORD_1"); a >= 0) mesh.uv1 = readVec2(model, a);
  if (const int a = attribute("COLOR_0"); a >= 0) mesh.colors = readVec4(model, a);
  for (Vec4& color : mesh.colors) color = glm::clamp(color, 0.0f, 1.0f);
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = readIndices(model, primitive.indices);
  } else {
    indices.resize(mesh.positions.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
  }
  mesh.indices = asTriangles(indices, primitive.mode);
  return mesh;
}

/// Before localMesh allocates: what it returns, and as much again while it is read.
void chargeMesh(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const std::string& what,
                LoadBudget& budget) {
  std::uint64_t elements = 0;
  const auto count = [&](int accessor) {
    return accessor < 0 ? 0 : model.accessors[static_cast<std::size_t>(accessor)].count;
  };
  for (const auto& [name, accessor] : primitive.attributes) elements += count(accessor);
  const std::uint64_t corners = primitive.indices < 0 ? elements : count(primitive.indices);
  budget.charge(elements, 2 * sizeof(Vec4), what);
  budget.charge(corners, 4 * sizeof(std::uint32_t), what);  // a strip has three corners for each of its own
}

/// Primitives with equal keys are one mesh, whatever glTF mesh and material they belong to.
using MeshKey = std::vector<int>;

/// All that localMesh reads, and the UV set along which tangents will be made: 0 also for those who need
/// none.
MeshKey keyOf(const tinygltf::Primitive& primitive, const Material& material) {
  MeshKey key = {primitive.mode, primitive.indices};
  for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"}) {
    const auto at = primitive.attributes.find(name);
    key.push_back(at == primitive.attributes.end() ? -1 : at->second);
  }
  const TextureSlot plain;
  const bool made = material.needsTangents() && !primitive.attributes.contains("TANGENT");
  const TextureSlot& slot = made ? tangentSlot(material) : plain;
  key.push_back(slot.uvSet);
  for (const float f : {slot.rotation, slot.scale.x, slot.scale.y}) key.push_back(std::bit_cast<int>(f));
  return key;
}

/// The meshes of a file, each read once.
class MeshReader {
 public:
  MeshReader(const tinygltf::Model& model, Scene& scene, LoadBudget& budget)
      : model_(model), scene_(scene), budget_(budget) {}

  /// Index into Scene::meshes. `what`: the element, for messages.
  std::uint32_t read(const tinygltf::Primitive& primitive, const Material& material,
                     const std::string& what) {
    const auto [at, isNew] =
        known_.try_emplace(keyOf(primitive, material), static_cast<std::uint32_t>(scene_.meshes.size()));
    if (!isNew) return at->second;
    chargeMesh(model_, primitive, what, budget_);
    scene_.meshes.push_back(localMesh(model_, primitive));
    scene_.meshes.back().instanced = true;
    triangles_ += scene_.meshes.back().triangleCount();
    if (triangles_ > kMaxStoredTriangles)
      throw Error(scene_.path + ": more than " + std::to_string(kMaxStoredTriangles) + " triangles");
    return at->second;
  }

 private:
  const tinygltf::Model& model_;
  Scene& scene_;
  LoadBudget& budget_;
  std::map<MeshKey, std::uint32_t> known_;
  std::size_t triangles_ = 0;
};

/// Objects place their meshes by their nodes; completeScene decides which of them stay shared.
void convertMeshes(const tinygltf::Model& model, const std::vector<int>& nodes, Scene& scene,
                   LoadBudget& budget) {
  int skipped = 0, positionless = 0;
  MeshReader reader(model, scene, budget);
  for (const int n : nodes) {
    const int meshIndex = model.nodes[static_cast<std::size_t>(n)].mesh;
    if (meshIndex < 0) continue;
    const auto& primitives = model.meshes[static_cast<std::size_t>(meshIndex)].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = primitives[p];
      if (!primitive.attributes.contains("POSITION")) {
        ++positionless;
        continue;
      }
      if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        ++skipped;
        continue;
      }
      Object object;
      object.meshToWorld = scene.nodes[static_cast<std::size_t>(n)].localToWorld;
      object.name = scene.nodes[static_cast<std::size_t>(n)].name;
      object.node = n;
      object.primitive = static_cast<int>(p);
      object.material =
          primitive.material >= 0 ? primitive.material : static_cast<int>(model.materials.size());
      object.mesh = reader.read(primitive, scene.materials[static_cast<std::size_t>(object.material)],
                                "meshes[" + std::to_string(meshIndex) + "]");
      scene.objects.push_back(std::move(object));
    }
  }
  if (skipped > 0)
    scene.warnings.push_back(std::to_string(skipped) + " primitives of points or lines are left out");
  if (positionless > 0)
    scene.warnings.push_back(std::to_string(positionless) + " primitives without POSITION are left out");
}

// ---- cameras and lights

void convertCameras(const tinygltf::Model& model, const std::vector<int>& nodes, Scene& scene) {
  int left = 0;
  for (const int n : nodes) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(n)];
    if (node.camera < 0) continue;
    const tinygltf::Camera& from = model.cameras[static_cast<std::size_t>(node.camera)];
    const Mat4& world = scene.nodes[static_cast<std::size_t>(n)].localToWorld;
    Camera camera;
    camera.name = !node.name.empty() ? node.name : from.name;
    camera.eye = Vec3(world[3]);
    camera.at = camera.eye - glm::normalize(Vec3(world[2]));
    camera.up = glm::normalize(Vec3(world[1]));
    camera.fovYDegrees = static_cast<float>(glm::degrees(from.perspective.yfov));
    const bool usable = from.type == "perspective" && camera.fovYDegrees > 0 && camera.fovYDegrees < 180 &&
                        glm::length(camera.at - camera.eye) > 0 && std::isfinite(glm::length(camera.up));
    if (usable) scene.cameras.push_back(camera);
    left += !usable;
  }
  if (left > 0)
    scene.warnings.push_back(std::to_string(left) +
                             " cameras are orthographic or degenerate and are left out");
}

PunctualLight convertLight(const tinygltf::Light& from, const Mat4& world, float unitScale) {
  PunctualLight light;
  light.name = from.name;
  if (from.type == "spot") light.type = PunctualLight::Type::spot;
  if (from.type == "directional") light.type = PunctualLight::Type::directional;
  light.position = Vec3(world[3]);
  light.direction = -glm::normalize(Vec3(world[2]));
  Vec3 color(1);
  if (from.color.size() == 3) color = glm::make_vec3(from.color.data());
  light.intensity = glm::max(color, Vec3(0)) * static_cast<float>(std::max(0.0, from.intensity));
  light.range = static_cast<float>(std::max(0.0, from.range)) * unitScale;
  light.cosInner = static_cast<float>(std::cos(from.spot.innerConeAngle));
  light.cosOuter = static_cast<float>(std::cos(from.spot.outerConeAngle));
  return light;
}

void convertLights(const tinygltf::Model& model, const std::vector<int>& nodes, float unitScale,
                   Scene& scene) {
  for (const int n : nodes) {
    const auto& extensions = model.nodes[static_cast<std::size_t>(n)].extensions;
    const auto at = extensions.find("KHR_lights_punctual");
    if (at == extensions.end()) continue;
    const int index = at->second.Get("light").GetNumberAsInt();
    scene.lights.push_back(convertLight(model.lights[static_cast<std::size_t>(index)],
                                        scene.nodes[static_cast<std::size_t>(n)].localToWorld, unitScale));
  }
}

}  // namespace

Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options, LoadBudget& budget) {
  GatedGltf gated = readGatedGltf(file, budget);
  tinygltf::Model model = parse(gated, file.filename().string());
  Scene scene;
  scene.path = file.string();
  scene.warnings = gated.warnings;
  scene.animations = poseNodes(model, options.timeSeconds, scene.warnings);
  convertMaterials(model, gated.images, options.unitScale, scene, budget);
  const std::vector<int> nodes = convertNodes(model, options, scene);
  convertMeshes(model, nodes, scene, budget);
  convertCameras(model, nodes, scene);
  convertLights(model, nodes, options.unitScale, scene);
  return scene;
}

}  // namespace saccade::core
