#include "core/scene/gltf_rules.h"

#include <algorithm>
#include <cstring>

#include "core/scene/gltf_gate.h"

namespace saccade::core {

void checkVersion(const Element& root) {
  const Element asset = root.member("asset");
  const std::string version = asset.text("version");
  if (!version.starts_with("2.")) asset.refuse("version is '" + version + "'; only glTF 2.x is read");
  if (asset.has("minVersion") && asset.text("minVersion") != "2.0")
    asset.refuse("needs at least version " + asset.text("minVersion") + "; 2.0 is supported");
}

void checkAsset(const Element& root, std::span<const char* const> supported, Warnings& warnings) {
  const auto known = [&](const std::string& name) {
    return std::any_of(supported.begin(), supported.end(), [&](const char* s) { return name == s; });
  };
  const auto names = [&](const char* key) {
    std::vector<std::string> out;
    if (!root.has(key)) return out;
    const Json& list = root.json()[key];
    if (!list.is_array()) root.refuse(std::string("'") + key + "' must be an array of names");
    for (const Json& n : list) {
      if (!n.is_string()) root.refuse(std::string("'") + key + "' must be an array of names");
      out.push_back(n.get<std::string>());
    }
    return out;
  };
  for (const std::string& name : names("extensionsRequired"))
    if (!known(name)) root.refuse("requires the extension " + name + ", which this program does not support");
  for (const std::string& name : names("extensionsUsed"))
    if (!known(name)) warnings.push_back("extension " + name + " is not supported; what it adds is left out");
}

namespace {

struct ViewSpan {
  const std::uint8_t* data;
  std::uint64_t length;
  std::uint64_t stride;
};

ViewSpan checkView(const Element& view, const std::vector<std::vector<std::uint8_t>>& buffers) {
  const auto& buffer = buffers[view.index("buffer", buffers.size(), "buffers")];
  const std::uint64_t offset = view.integerOr("byteOffset", 0, 0, buffer.size());
  const std::uint64_t length = view.integer("byteLength", 1, buffer.size());
  if (length > buffer.size() - offset)
    view.refuse("reaches byte " + std::to_string(offset + length) + " of a buffer of " +
                std::to_string(buffer.size()));
  return {buffer.data() + offset, length, view.integerOr("byteStride", 0, 4, 252)};
}

/// `count` elements of `bytes` each, `stride` apart, from `offset`, must lie within the view.
void checkRange(const Element& who, const ViewSpan& view, std::uint64_t offset, std::uint64_t count,
                std::uint64_t bytes, std::uint64_t stride) {
  // All of these are below 2^60, so the sums below cannot wrap.
  if (stride < bytes) who.refuse("byteStride is smaller than one element");
  if (offset > view.length || (count - 1) * stride + bytes > view.length - offset)
    who.refuse("reaches beyond its bufferView of " + std::to_string(view.length) + " bytes");
}

GltfAccessor::Sparse checkSparse(const Element& accessor, std::uint64_t count, std::uint64_t elementBytes,
                                 const std::vector<ViewSpan>& views) {
  const Element sparse = accessor.member("sparse");
  const std::uint64_t n = sparse.integer("count", 1, count);
  const Element indices = sparse.member("indices"), values = sparse.member("values");
  const ViewSpan& indexView = views[indices.index("bufferView", views.size(), "bufferViews")];
  const ViewSpan& valueView = views[values.index("bufferView", views.size(), "bufferViews")];
  const std::uint64_t bytes = gltfComponentBytes(indices.integer("componentType", 5121, 5125));
  const std::uint64_t offset = indices.integerOr("byteOffset", 0, 0, indexView.length);
  const std::uint64_t valueOffset = values.integerOr("byteOffset", 0, 0, valueView.length);
  checkRange(indices, indexView, offset, n, bytes, bytes);
  checkRange(values, valueView, valueOffset, n, elementBytes, elementBytes);
  std::uint64_t before = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t index = unsignedFrom(indexView.data + offset + i * bytes, bytes);
    if (index >= count)
      indices.refuse("names element " + std::to_string(index) + " of " + std::to_string(count));
    if (i > 0 && index <= before) indices.refuse("must increase strictly");
    before = index;
  }
  return {n, bytes, indexView.data + offset, valueView.data + valueOffset};
}

}  // namespace

std::vector<GltfAccessor> checkAccessors(const Element& root,
                                         const std::vector<std::vector<std::uint8_t>>& buffers) {
  std::vector<ViewSpan> views;
  for (const Element& view : root.array("bufferViews")) views.push_back(checkView(view, buffers));
  std::vector<GltfAccessor> out;
  for (const Element& accessor : root.array("accessors")) {
    GltfAccessor a;
    a.componentType = accessor.integer("componentType", 5120, 5126);
    a.components = gltfComponents(accessor.text("type"));
    a.count = accessor.integer("count", 1, kMaxAccessorElements);
    a.normalized = accessor.has("normalized") && accessor.json()["normalized"].get<bool>();
    const std::uint64_t bytes = gltfComponentBytes(a.componentType) * a.components;
    if (accessor.has("bufferView")) {
      const ViewSpan& view = views[accessor.index("bufferView", views.size(), "bufferViews")];
      const std::uint64_t offset = accessor.integerOr("byteOffset", 0, 0, view.length);
      a.stride = view.stride == 0 ? bytes : view.stride;
      checkRange(accessor, view, offset, a.count, bytes, a.stride);
      a.data = view.data + offset;
    }
    if (accessor.has("sparse")) a.sparse = checkSparse(accessor, a.count, bytes, views);
    out.push_back(a);
  }
  return out;
}

namespace {

void checkAttribute(const Element& primitive, const std::string& name, const Json& value,
                    const std::vector<Element>& accessors, std::uint64_t& vertexCount) {
  const auto index = gltfInteger(value);
  if (!index || *index >= accessors.size())
    primitive.refuse("attribute " + name + " is " + value.dump() + ", but there are " +
                     std::to_string(accessors.size()) + " accessors");
  const Element& accessor = accessors[*index];
  const std::string type = accessor.text("type");
  const std::uint64_t component = accessor.integer("componentType", 5120, 5126);
  const auto must = [&](bool good, const char* rule) {
    if (!good) primitive.refuse("attribute " + name + " must be " + rule + ", is " + type);
  };
  if (name == "POSITION" || name == "NORMAL") must(type == "VEC3", "VEC3");
  if (name == "TANGENT") must(type == "VEC4", "VEC4");
  if (name.starts_with("TEXCOORD_")) must(type == "VEC2", "VEC2");
  if (name.starts_with("COLOR_")) must(type == "VEC3" || type == "VEC4", "VEC3 or VEC4");
  if (component == 5125) primitive.refuse("attribute " + name + " must not be of unsigned int components");
  const std::uint64_t count = accessor.integer("count", 1, kMaxAccessorElements);
  if (vertexCount == 0) vertexCount = count;
  if (count != vertexCount) primitive.refuse("attribute " + name + " has another count than the others");
}

void checkPrimitive(const Element& primitive, const std::vector<Element>& accessors) {
  const Element attributes = primitive.member("attributes");
  std::uint64_t vertexCount = 0;
  for (const auto& [name, value] : attributes.json().items())
    checkAttribute(primitive, name, value, accessors, vertexCount);
  if (!primitive.has("indices")) return;
  const Element& indices = accessors[primitive.index("indices", accessors.size(), "accessors")];
  const std::uint64_t component = indices.integer("componentType", 5120, 5126);
  if (indices.text("type") != "SCALAR" || (component != 5121 && component != 5123 && component != 5125))
    primitive.refuse("indices must be unsigned scalars");
}

void checkLights(const Element& root, std::size_t& lightCount) {
  lightCount = 0;
  if (!root.has("extensions") || !root.member("extensions").has("KHR_lights_punctual")) return;
  const auto lights = root.member("extensions").member("KHR_lights_punctual").array("lights");
  lightCount = lights.size();
  for (const Element& light : lights) {
    const std::string type = light.text("type");
    if (type != "point" && type != "spot" && type != "directional")
      light.refuse("unknown light type '" + type + "'");
  }
}

void checkCameras(const Element& root) {
  for (const Element& camera : root.array("cameras")) {
    const std::string type = camera.text("type");
    if (type != "perspective" && type != "orthographic") camera.refuse("unknown camera type '" + type + "'");
    const Element lens = camera.member(type.c_str());
    const char* const perspective[] = {"yfov", "znear"};
    const char* const orthographic[] = {"xmag", "ymag", "zfar", "znear"};
    const std::span<const char* const> needed = type == "perspective"
                                                    ? std::span<const char* const>(perspective)
                                                    : std::span<const char* const>(orthographic);
    for (const char* key : needed)
      if (!lens.has(key) || !lens.json()[key].is_number())
        lens.refuse(std::string("lacks the number '") + key + "'");
  }
}

std::vector<std::size_t> indexList(const Element& owner, const char* key, std::size_t count,
                                   const char* what) {
  std::vector<std::size_t> out;
  if (!owner.has(key)) return out;
  const Json& list = owner.json()[key];
  if (!list.is_array()) owner.refuse(std::string("'") + key + "' must be an array");
  for (const Json& v : list) {
    const auto index = gltfInteger(v);
    if (!index || *index >= count)
      owner.refuse(std::string("'") + key + "' holds " + v.dump() + ", but there are " +
                   std::to_string(count) + " " + what);
    out.push_back(static_cast<std::size_t>(*index));
  }
  return out;
}

/// One parent each, then: walking up from every node ends at a root. Returns the parents.
std::vector<std::ptrdiff_t> checkForest(const std::vector<Element>& nodes) {
  std::vector<std::ptrdiff_t> parent(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const std::size_t child : indexList(nodes[i], "children", nodes.size(), "nodes")) {
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

void checkNodes(const Element& root, std::size_t lights) {
  const auto nodes = root.array("nodes");
  for (const Element& node : nodes) {
    if (!node.has("extensions") || !node.member("extensions").has("KHR_lights_punctual")) continue;
    node.member("extensions").member("KHR_lights_punctual").index("light", lights, "lights");
  }
  const std::vector<std::ptrdiff_t> parent = checkForest(nodes);
  const auto scenes = root.array("scenes");
  for (const Element& scene : scenes)
    for (const std::size_t node : indexList(scene, "nodes", nodes.size(), "nodes"))
      if (parent[node] >= 0) scene.refuse("names node " + std::to_string(node) + ", which is not a root");
  root.optionalIndex("scene", scenes.size(), "scenes");
}

}  // namespace

void checkReferences(const Element& root) {
  const auto accessors = root.array("accessors");
  for (const Element& mesh : root.array("meshes")) {
    const auto primitives = mesh.array("primitives");
    if (primitives.empty()) mesh.refuse("has no primitives");
    for (const Element& primitive : primitives) checkPrimitive(primitive, accessors);
  }
  std::size_t lights = 0;
  checkLights(root, lights);
  checkCameras(root);
  checkNodes(root, lights);
}

}  // namespace saccade::core
