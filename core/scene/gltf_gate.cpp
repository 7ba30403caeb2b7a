#include "core/scene/gltf_gate.h"

#include <array>
#include <cstring>
#include <span>

#include "core/scene/confined_file.h"
#include "core/scene/gltf_resources.h"
#include "core/scene/gltf_rules.h"
#include "core/scene/gltf_schema.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::array kSupportedExtensions = {"KHR_lights_punctual",
                                             "KHR_materials_anisotropy",
                                             "KHR_materials_clearcoat",
                                             "KHR_materials_dispersion",
                                             "KHR_materials_emissive_strength",
                                             "KHR_materials_ior",
                                             "KHR_materials_iridescence",
                                             "KHR_materials_pbrSpecularGlossiness",
                                             "KHR_materials_sheen",
                                             "KHR_materials_specular",
                                             "KHR_materials_transmission",
                                             "KHR_materials_unlit",
                                             "KHR_materials_volume",
                                             "KHR_mesh_quantization",
                                             "KHR_texture_transform",
                                             "MOZ_lightmap",
                                             "SACCADE_emission"};

/// What one value of JSON becomes: in our tree, in the checked copy, in tinygltf's tree and model.
constexpr std::uint64_t kBytesPerJsonValue = 250;

/// Commas, colons and brackets outside strings: no fewer than the text has values.
std::uint64_t countValues(std::span<const std::uint8_t> text) {
  std::uint64_t count = 1;
  bool inString = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = static_cast<char>(text[i]);
    if (inString && c == '\\') {
      ++i;
    } else if (c == '"') {
      inString = !inString;
    } else {
      count += !inString && (c == ',' || c == ':' || c == '[' || c == '{');
    }
  }
  return count;
}

/// Some writers put NaN where JSON has no number. Read as null, which checkSchema drops where a default is
/// at hand and refuses elsewhere. Empty if there is none.
std::vector<std::uint8_t> withoutNotANumber(std::span<const std::uint8_t> text, const std::string& who,
                                            Repairs& repairs, LoadBudget& budget) {
  static constexpr std::string_view kToken = "NaN", kNull = "null";
  const std::string_view from(reinterpret_cast<const char*>(text.data()), text.size());
  std::vector<std::uint8_t> out;
  std::size_t copied = 0;
  bool inString = false;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] == '"') inString = !inString;
    if (inString && from[i] == '\\') ++i;
    if (inString || !from.substr(i).starts_with(kToken)) continue;
    if (copied == 0) budget.charge(2 * from.size(), "JSON");
    repairs.add("numbers of the JSON are NaN; their defaults were taken", who);
    out.insert(out.end(), from.begin() + static_cast<std::ptrdiff_t>(copied),
               from.begin() + static_cast<std::ptrdiff_t>(i));
    out.insert(out.end(), kNull.begin(), kNull.end());
    i += kToken.size() - 1;
    copied = i + 1;
  }
  if (copied > 0) out.insert(out.end(), from.begin() + static_cast<std::ptrdiff_t>(copied), from.end());
  return out;
}

Json parseJson(std::span<const std::uint8_t> text, const std::string& who, Repairs& repairs,
               LoadBudget& budget) {
  budget.charge(text.size(), "JSON");
  budget.charge(countValues(text), kBytesPerJsonValue, "JSON");
  // A byte order mark is no JSON (RFC 8259, section 8.1).
  static constexpr std::array<std::uint8_t, 3> kMark = {0xEF, 0xBB, 0xBF};
  if (text.size() >= kMark.size() && std::equal(kMark.begin(), kMark.end(), text.begin()))
    repairs.add("byte order marks before the JSON were skipped", who);
  const std::vector<std::uint8_t> mended = withoutNotANumber(text, who, repairs, budget);
  if (!mended.empty()) text = mended;
  const auto depthGuard = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxJsonDepth)
      throw Error(who + ": JSON nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
    return true;
  };
  try {
    Json json = Json::parse(text.begin(), text.end(), depthGuard);
    if (!json.is_object()) throw Error(who + ": not a glTF file (no JSON object)");
    return json;
  } catch (const Json::exception& e) {
    throw Error(who + ": not a glTF file (" + e.what() + ")");
  }
}

/// Copies of the checked parts only, so that nothing unchecked reaches tinygltf.
std::string checkedJson(const Json& json, std::size_t bufferCount) {
  Json out = Json::object();
  for (const char* key :
       {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "materials",
        "textures", "samplers", "cameras", "animations", "extensions"})
    if (json.contains(key)) out[key] = json[key];
  for (std::size_t i = 0; i < bufferCount; ++i)
    out["buffers"][i]["uri"] = std::string("buffer") + std::to_string(i);
  const auto strip = [](Json& list, std::initializer_list<const char*> keys) {
    for (Json& element : list)
      for (const char* key : keys) element.erase(key);
  };
  for (auto& [key, value] : out.items()) {
    if (!value.is_array()) continue;
    strip(value, {"skin", "weights"});
    if (key != "materials") strip(value, {"extras"});  // Ward's lobe stands in a material's extras
  }
  if (!out.contains("meshes")) return out.dump();
  for (Json& mesh : out["meshes"]) strip(mesh["primitives"], {"extras", "targets", "extensions"});
  return out.dump();
}

/// Textures of images that are not read have none.
void leaveOutImages(Json& json, const std::vector<EncodedImage>& images) {
  if (!json.contains("textures")) return;
  for (Json& texture : json["textures"])
    if (texture.contains("source") && images[texture["source"].get<std::size_t>()].bytes.empty())
      texture.erase("source");
}

void warnOfWhatIsLeftOut(const Json& json, Warnings& warnings) {
  for (const auto& [key, what] :
       {std::pair{"skins", "skins are ignored; skinned meshes stand in their bind pose"}})
    if (json.contains(key) && json[key].is_array() && !json[key].empty()) warnings.emplace_back(what);
  for (const Json& mesh : json.value("meshes", Json::array()))
    for (const Json& primitive : mesh.value("primitives", Json::array()))
      if (primitive.contains("targets")) {
        warnings.emplace_back("morph targets are ignored");
        return;
      }
}

}  // namespace

GatedGltf readGatedGltf(const fs::path& file, LoadBudget& budget) {
  const std::string who = file.filename().string();
  const Bytes bytes = readSceneFile(file, budget);
  if (bytes.empty()) throw Error(who + ": the file is empty");
  GatedGltf out;
  Repairs repairs;
  const GltfParts parts = splitGlb(bytes, who, repairs);
  Json json = parseJson(parts.json, who, repairs, budget);
  const Element root(json, who);
  checkVersion(root);
  checkSchema(json, who, repairs);
  checkAsset(root, kSupportedExtensions, out.warnings, repairs);
  const GltfSource source{file.parent_path(), parts, repairs, budget};
  out.buffers = readBuffers(root, source);
  const std::vector<GltfAccessor> accessors = checkAccessors(root, out.buffers, repairs, budget);
  checkUsage(root, repairs);
  checkMeshes(root, accessors, repairs, budget);
  checkGraph(json, who, repairs);
  checkAnimations(json, who, accessors, repairs, budget);
  out.images = readImages(root, out.buffers, source);
  leaveOutImages(json, out.images);
  repairs.report(out.warnings);
  warnOfWhatIsLeftOut(json, out.warnings);
  out.json = checkedJson(json, out.buffers.size());
  return out;
}

}  // namespace saccade::core
