#include "core/scene/gltf_rules.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::core {

void checkVersion(const Element& root) {
  const Element asset = root.member("asset");
  const std::string version = asset.text("version");
  const bool digits = version.size() > 2 && std::all_of(version.begin() + 2, version.end(),
                                                        [](char c) { return c >= '0' && c <= '9'; });
  if (!version.starts_with("2.") || !digits)
    asset.refuse("version is '" + version + "'; only glTF 2.x is read");
  if (asset.has("minVersion") && asset.text("minVersion") != "2.0")
    asset.refuse("needs at least version " + asset.text("minVersion") + "; 2.0 is supported");
}

void checkAsset(const Element& root, std::span<const char* const> supported, Warnings& warnings,
                Repairs& repairs) {
  const auto known = [&](const std::string& name) {
    return std::any_of(supported.begin(), supported.end(), [&](const char* s) { return name == s; });
  };
  static const Json kNone = Json::array();
  const auto names = [&](const char* key) -> const Json& { return root.has(key) ? root.json()[key] : kNone; };
  const Json &required = names("extensionsRequired"), &used = names("extensionsUsed");
  const auto contains = [](const Json& list, const Json& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const Json& name : required) {
    if (!known(name.get<std::string>()))
      root.refuse("requires the extension " + name.get<std::string>() +
                  ", which this program does not support");
    if (!contains(used, name))
      repairs.add("extensions are required that 'extensionsUsed' does not name", root.path());
  }
  for (const Json& name : used)
    if (!known(name.get<std::string>()))
      warnings.push_back("extension " + name.get<std::string>() +
                         " is not supported; what it adds is left out");
  if (contains(used, "KHR_mesh_quantization") && !contains(required, "KHR_mesh_quantization"))
    repairs.add("files use KHR_mesh_quantization without requiring it", root.path());
}

namespace {

/// Number of lights. Those without meaning shine no more.
std::size_t checkLights(Json& root, const std::string& file, Repairs& repairs) {
  const Json::json_pointer where("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(where)) return 0;
  Json& lights = root[where];
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Json& light = lights[i];
    const std::string path = file + ": lights[" + std::to_string(i) + "]";
    if (light["type"] != "point" && light["type"] != "spot" && light["type"] != "directional") {
      repairs.add("lights of a type that glTF does not know were put out", path);
      light = {{"type", "point"}, {"intensity", 0}};
    }
    if (light["type"] != "spot") continue;
    if (!light.contains("spot")) {
      repairs.add("spot lights without a cone were given glTF's default one", path);
      light["spot"] = Json::object();
    }
    Json& cone = light["spot"];
    constexpr double kDefaultOuter = 0.7853981633974483;  // pi/4
    if (cone.value("innerConeAngle", 0.0) < cone.value("outerConeAngle", kDefaultOuter)) continue;
    repairs.add("spot lights whose inner cone is not inside the outer one were given no inner one", path);
    cone.erase("innerConeAngle");
  }
  return lights.size();
}

/// What a perspective or orthographic camera breaks, or null.
const char* cameraFault(const Json& camera) {
  const bool perspective = camera.contains("perspective"), orthographic = camera.contains("orthographic");
  if (perspective == orthographic)
    return "cameras that are not either perspective or orthographic were left out";
  if (!camera.contains(camera["type"].get<std::string>()))
    return "cameras of another type than they say were left out";
  if (orthographic) {
    const Json& lens = camera["orthographic"];
    const bool flat = lens["xmag"] == 0 || lens["ymag"] == 0;
    const bool empty = flat || !(lens["zfar"] > lens["znear"]) || lens["znear"] < 0;
    return empty ? "orthographic cameras without extent were left out" : nullptr;
  }
  const Json& lens = camera["perspective"];
  return lens["yfov"] > 0 ? nullptr : "cameras with a field of view of 0 or less were left out";
}

void checkCameras(Json& root, const std::string& file, Repairs& repairs) {
  if (!root.contains("cameras")) return;
  for (std::size_t i = 0; i < root["cameras"].size(); ++i) {
    Json& camera = root["cameras"][i];
    const std::string path = file + ": cameras[" + std::to_string(i) + "]";
    if (const char* fault = cameraFault(camera)) {
      repairs.add(fault, path);
      // The loader leaves orthographic ones out.
      camera = {{"type", "orthographic"},
                {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 1}, {"znear", 0}}}};
    }
    if (!camera.contains("perspective")) continue;
    const Json& lens = camera["perspective"];
    if (!(lens["znear"] > 0) || (lens.contains("zfar") && lens["zfar"] <= lens["znear"]))
      repairs.add("cameras whose depth range is empty were given this program's own", path);
  }
}

/// One parent each, then: walking up from every node ends at a root. Returns the parents.
std::vector<std::ptrdiff_t> checkForest(const std::vector<Element>& nodes) {
  std::vector<std::ptrdiff_t> parent(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].has("children")) continue;
    for (const Json& entry : nodes[i].json()["children"]) {
      const auto child = entry.get<std::size_t>();
      if (parent[child] >= 0) nodes[child].refuse("has two parents");
      parent[child] = static_cast<std::ptrdiff_t>(i);
    }
  }
  std::vector<char> endsAtRoot(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::vector<std::size_t> path;
    std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i);
    while (at >= 0 && !endsAtRoot[static_cast<std::size_t>(at)]) {
      path.push_back(static_cast<std::size_t>(at));
      if (path.size() > nodes.size()) nodes[i].refuse("lies in a cycle of nodes");
      at = parent[static_cast<std::size_t>(at)];
    }
    for (const std::size_t n : path) endsAtRoot[n] = 1;
  }
  return parent;
}

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The three columns are perpendicular and not 0, and the last row is 0, 0, 0, 1.
bool isTranslationRotationScale(const Json& matrix) {
  constexpr double kTolerance = 5e-4;  // of the cosine: matrices are written with few digits
  std::array<double, 16> m;
  for (std::size_t i = 0; i < 16; ++i) m[i] = matrix[i].get<double>();
  const double* columns[3] = {&m[0], &m[4], &m[8]};
  for (int i = 0; i < 3; ++i) {
    const double *a = columns[i], *b = columns[(i + 1) % 3];
    const double lengths = std::sqrt(dot(a, a) * dot(b, b));
    if (!(lengths > 0) || std::abs(dot(a, b)) > kTolerance * lengths) return false;
  }
  return m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1;
}

void checkTransform(const Element& node, Repairs& repairs) {
  const Json& json = node.json();
  if (node.has("matrix")) {
    if (!isTranslationRotationScale(json["matrix"]))
      repairs.add("node matrices are singular, sheared or projective and were taken as they stand",
                  node.path());
    if (node.has("translation") || node.has("rotation") || node.has("scale"))
      repairs.add("nodes have both a matrix and translation, rotation or scale; the matrix was taken",
                  node.path());
  }
  if (!node.has("rotation")) return;
  double square = 0;
  for (const Json& x : json["rotation"]) square += x.get<double>() * x.get<double>();
  constexpr double kTolerance = 0.00769;
  if (square > 0 && !(std::abs(std::sqrt(square) - 1) <= kTolerance))
    repairs.add("node rotations were not of unit length and were normalised", node.path());
}

/// Skins and morph targets are left out as a whole; what is wrong with their use is reported all the same.
void checkSkinUse(const Element& node, const std::vector<Element>& meshes, Repairs& repairs) {
  const Json* mesh = node.has("mesh") ? &meshes[node.json()["mesh"].get<std::size_t>()].json() : nullptr;
  const Json* first = mesh ? &(*mesh)["primitives"][0] : nullptr;
  if (node.has("skin") && !(first && (*first)["attributes"].contains("JOINTS_0")))
    repairs.add("nodes have a skin without a mesh that has joints; it is ignored", node.path());
  if (!node.has("weights")) return;
  const std::size_t targets = first && first->contains("targets") ? (*first)["targets"].size() : 0;
  if (node.json()["weights"].size() != targets)
    repairs.add("morph weights do not fit the targets; both are ignored", node.path());
}

void checkNodes(const Element& root, std::size_t lights, Repairs& repairs) {
  const auto nodes = root.array("nodes"), meshes = root.array("meshes");
  for (const Element& node : nodes) {
    checkTransform(node, repairs);
    checkSkinUse(node, meshes, repairs);
    if (!node.has("extensions") || !node.member("extensions").has("KHR_lights_punctual")) continue;
    node.member("extensions").member("KHR_lights_punctual").index("light", lights, "lights");
  }
  const std::vector<std::ptrdiff_t> parent = checkForest(nodes);
  for (const Element& scene : root.array("scenes")) {
    if (!scene.has("nodes")) continue;
    for (const Json& node : scene.json()["nodes"])
      if (parent[node.get<std::size_t>()] >= 0)
        scene.refuse("names node " + node.dump() + ", which is not a root");
  }
}

}  // namespace

void checkGraph(Json& root, const std::string& file, Repairs& repairs) {
  const std::size_t lights = checkLights(root, file, repairs);
  checkCameras(root, file, repairs);
  checkNodes(Element(root, file), lights, repairs);
}

}  // namespace saccade::core
