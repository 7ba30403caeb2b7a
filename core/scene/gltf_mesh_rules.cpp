// glTF 2.0, 3.7: primitives, their attributes, indices and morph targets, and what their material asks of
// them.
#include <algorithm>
#include <cmath>
#include <map>

#include "core/scene/gltf_rules.h"

namespace saccade::core {
namespace {

constexpr std::uint64_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                        kUnsignedInt = 5125, kFloat = 5126;
/// What 8-bit components lose of a unit vector's length.
constexpr float kUnitTolerance = 0.00769f;

struct Primitive {
  const Element& element;
  std::map<std::string, const GltfAccessor*> attributes;
  bool has(const std::string& name) const { return attributes.contains(name); }
};

const GltfAccessor& at(const Json& index, const std::vector<GltfAccessor>& accessors) {
  return accessors[index.get<std::size_t>()];  // checkSchema has seen to the range
}

// ---- attributes

bool isSet(const std::string& name, const char* prefix) {
  return name.starts_with(prefix) && name.size() > std::string(prefix).size() &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(std::string(prefix).size()), name.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Number of components that the attribute must have, as bits 1 << n; 0: any.
unsigned componentsOf(const std::string& name) {
  if (name == "POSITION" || name == "NORMAL") return 1u << 3;
  if (name == "TANGENT") return 1u << 4;
  if (isSet(name, "TEXCOORD_")) return 1u << 2;
  if (isSet(name, "COLOR_")) return 1u << 3 | 1u << 4;
  if (isSet(name, "JOINTS_") || isSet(name, "WEIGHTS_")) return 1u << 4;
  return 0;
}

/// Component types of glTF 2.0, 3.7.2.1, KHR_mesh_quantization left aside.
bool usualFormat(const std::string& name, const GltfAccessor& a) {
  const bool small = a.componentType == kUnsignedByte || a.componentType == kUnsignedShort;
  if (isSet(name, "JOINTS_")) return small && !a.normalized;
  if (a.componentType == kFloat) return true;
  if (isSet(name, "TEXCOORD_") || isSet(name, "COLOR_") || isSet(name, "WEIGHTS_"))
    return small && a.normalized;
  return componentsOf(name) == 0;
}

/// The same with KHR_mesh_quantization.
bool quantizedFormat(const std::string& name, const GltfAccessor& a) {
  const bool isSigned = a.componentType == kByte || a.componentType == kShort;
  if (name == "POSITION" || isSet(name, "TEXCOORD_")) return a.componentType <= kUnsignedShort;
  return (name == "NORMAL" || name == "TANGENT") && isSigned && a.normalized;
}

void checkAttribute(const Primitive& primitive, const std::string& name, bool quantization,
                    Repairs& repairs) {
  const GltfAccessor& a = *primitive.attributes.at(name);
  const Element& element = primitive.element;
  const unsigned allowed = componentsOf(name);
  if (allowed != 0 && (allowed >> a.components & 1u) == 0) {
    const char* rule = allowed == 1u << 2   ? "VEC2"
                       : allowed == 1u << 3 ? "VEC3"
                       : allowed == 1u << 4 ? "VEC4"
                                            : "VEC3 or VEC4";
    element.refuse("attribute " + name + " must be " + rule);
  }
  if (a.componentType == kUnsignedInt && !name.starts_with('_'))
    element.refuse("attribute " + name + " must not be of unsigned int components");
  if (allowed == 0 && !name.starts_with('_'))
    repairs.add("vertex attributes with a name that glTF does not know were ignored", element.path());
  if (!usualFormat(name, a) && !(quantization && quantizedFormat(name, a)))
    repairs.add(
        "vertex attributes have a component type that glTF does not allow for them and were read as it",
        element.path());
}

void checkUnitLength(const Element& element, const GltfAccessor& a, bool isTangent, Repairs& repairs) {
  std::uint64_t offLength = 0, offSign = 0;
  forEachElement(a, [&](std::uint64_t, const float* x) {
    const float length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    offLength += !(std::abs(length - 1) <= kUnitTolerance);
    offSign += isTangent && x[3] != 1 && x[3] != -1;
  });
  if (offLength > 0)
    repairs.add("normals and tangents were not of unit length and are normalised", element.path(), offLength);
  if (offSign > 0)
    repairs.add("tangents had a sign other than 1 and -1, which was taken by its sign", element.path(),
                offSign);
}

void checkContents(const Primitive& primitive, Repairs& repairs) {
  for (const auto& [name, accessor] : primitive.attributes) {
    if (name == "NORMAL" || name == "TANGENT")
      checkUnitLength(primitive.element, *accessor, name == "TANGENT", repairs);
    if (isSet(name, "COLOR_") && accessor->componentType == kFloat) {
      std::uint64_t outside = 0;
      const std::size_t components = accessor->components;
      forEachElement(*accessor, [&](std::uint64_t, const float* x) {
        for (std::size_t c = 0; c < components; ++c) outside += !(x[c] >= 0 && x[c] <= 1);
      });
      if (outside > 0)
        repairs.add("vertex colours out of range were clamped", primitive.element.path(), outside);
    }
  }
}

/// TEXCOORD_n and the like must start at 0 and have no gap.
void checkSets(const Primitive& primitive, Repairs& repairs) {
  for (const char* prefix : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"}) {
    std::size_t count = 0;
    for (const auto& [name, accessor] : primitive.attributes) count += isSet(name, prefix);
    for (std::size_t i = 0; i < count; ++i)
      if (!primitive.has(prefix + std::to_string(i))) {
        repairs.add("primitives number their attribute sets with gaps", primitive.element.path());
        break;
      }
  }
  const auto& all = primitive.attributes;
  const auto countOf = [&](const char* prefix) {
    return std::count_if(all.begin(), all.end(), [&](const auto& a) { return isSet(a.first, prefix); });
  };
  if (countOf("JOINTS_") != countOf("WEIGHTS_"))
    repairs.add("primitives have joints and weights in different number; skins are ignored",
                primitive.element.path());
  if (primitive.has("TANGENT") && !primitive.has("NORMAL"))
    repairs.add("primitives have tangents without normals; both are computed", primitive.element.path());
}

// ---- indices

void checkIndices(const Primitive& primitive, const GltfAccessor& a, std::uint64_t vertices,
                  Repairs& repairs) {
  const Element& element = primitive.element;
  if (a.components != 1 || a.normalized ||
      (a.componentType != kUnsignedByte && a.componentType != kUnsignedShort &&
       a.componentType != kUnsignedInt))
    element.refuse("indices must be unsigned scalars");
  const std::uint64_t bytes = gltfComponentBytes(a.componentType);
  const std::uint32_t restart = static_cast<std::uint32_t>(0xFFFFFFFFu >> (32 - 8 * bytes));
  std::uint64_t outside = 0, restarts = 0;
  const auto look = [&](const std::uint8_t* from) {
    const std::uint32_t index = unsignedFrom(from, bytes);
    outside += index >= vertices;
    restarts += index == restart;
  };
  if (a.data)
    for (std::uint64_t i = 0; i < a.count; ++i) look(a.data + i * a.stride);
  for (std::uint64_t i = 0; i < a.sparse.count; ++i) look(a.sparse.values + i * bytes);
  if (outside > 0)
    repairs.add("indices name vertices that are not there; their triangles are dropped", element.path(),
                outside);
  if (restarts > 0 && restarts != outside)
    repairs.add("indices have the value that restarts primitives and were taken as vertices", element.path(),
                restarts);
}

// ---- morph targets, which are not shown

void checkTargets(const Primitive& primitive, const std::vector<GltfAccessor>& accessors,
                  std::uint64_t vertices, Repairs& repairs) {
  const Element& element = primitive.element;
  if (!element.has("targets")) return;
  const auto targets = element.array("targets");
  for (const Element& target : targets)
    for (const auto& [name, value] : target.json().items()) {
      const auto index = gltfInteger(value);
      if (!index || *index >= accessors.size())
        target.refuse("'" + name + "' is " + value.dump() + ", but there are " +
                      std::to_string(accessors.size()) + " accessors");
      if (!primitive.has(name) || accessors[*index].count != vertices)
        repairs.add("morph targets do not fit their primitive; they are ignored", target.path());
    }
}

void checkTargetCounts(const Element& mesh, const std::vector<Element>& primitives, Repairs& repairs) {
  const std::size_t first = primitives[0].array("targets").size();
  for (const Element& primitive : primitives)
    if (primitive.array("targets").size() != first)
      repairs.add("meshes whose primitives differ in morph targets; these are ignored", mesh.path());
  if (mesh.has("weights") && mesh.json()["weights"].size() != first)
    repairs.add("morph weights do not fit the targets; both are ignored", mesh.path());
}

// ---- what the material asks for

/// The UV set of a texture reference, KHR_texture_transform's own if it has one.
std::uint64_t uvSetOf(const Json& info) {
  const Json& extensions = info.contains("extensions") ? info["extensions"] : info;
  if (extensions.contains("KHR_texture_transform") &&
      extensions["KHR_texture_transform"].contains("texCoord"))
    return extensions["KHR_texture_transform"]["texCoord"].get<std::uint64_t>();
  return info.value("texCoord", std::uint64_t{0});
}

/// Calls visit(UV set) for every texture reference below `json`: the members named ...Texture.
template <class Visit>
void forEachTexture(const Json& json, const Visit& visit) {
  for (const auto& [key, value] : json.items()) {
    if (!value.is_object() || key == "extras") continue;
    if (key.ends_with("Texture") && value.contains("index")) {
      visit(uvSetOf(value));
    } else {
      forEachTexture(value, visit);
    }
  }
}

void checkMaterialNeeds(const Primitive& primitive, const Json& material, Repairs& repairs) {
  bool lacks = false;
  forEachTexture(material,
                 [&](std::uint64_t set) { lacks |= !primitive.has("TEXCOORD_" + std::to_string(set)); });
  if (lacks)
    repairs.add("primitives lack the UV set that a texture of their material uses; their first is taken",
                primitive.element.path());
  const Json& extensions = material.contains("extensions") ? material["extensions"] : material;
  const bool anisotropic = extensions.contains("KHR_materials_anisotropy");
  const bool coatNormal = extensions.contains("KHR_materials_clearcoat") &&
                          extensions["KHR_materials_clearcoat"].contains("clearcoatNormalTexture");
  if ((anisotropic || coatNormal) && !material.contains("normalTexture") && !primitive.has("TANGENT"))
    repairs.add("primitives lack the tangents that their material needs; they are computed from UV",
                primitive.element.path());
}

}  // namespace

void checkMeshes(const Element& root, const std::vector<GltfAccessor>& accessors, Repairs& repairs,
                 LoadBudget& budget) {
  const auto materials = root.array("materials");
  const Json& json = root.json();
  const bool quantization = json.contains("extensionsUsed") &&
                            std::find(json["extensionsUsed"].begin(), json["extensionsUsed"].end(),
                                      "KHR_mesh_quantization") != json["extensionsUsed"].end();
  for (const Element& mesh : root.array("meshes")) {
    const auto primitives = mesh.array("primitives");
    for (const Element& element : primitives) {
      budget.checkTime();
      Primitive primitive{element, {}};
      std::uint64_t vertices = 0;
      for (const auto& [name, value] : element.json()["attributes"].items()) {
        const GltfAccessor& a = at(value, accessors);
        primitive.attributes[name] = &a;
        if (vertices == 0) vertices = a.count;
        if (a.count != vertices) element.refuse("attribute " + name + " has another count than the others");
      }
      for (const auto& [name, a] : primitive.attributes)
        checkAttribute(primitive, name, quantization, repairs);
      checkContents(primitive, repairs);
      checkSets(primitive, repairs);
      if (element.has("indices"))
        checkIndices(primitive, at(element.json()["indices"], accessors), vertices, repairs);
      checkTargets(primitive, accessors, vertices, repairs);
      if (element.has("material"))
        checkMaterialNeeds(primitive, materials[element.json()["material"].get<std::size_t>()].json(),
                           repairs);
    }
    checkTargetCounts(mesh, primitives, repairs);
  }
}

}  // namespace saccade::core
