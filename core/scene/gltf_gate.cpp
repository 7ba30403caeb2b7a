#include "core/scene/gltf_gate.h"

#include <array>
#include <cstring>
#include <span>

#include "core/scene/confined_file.h"
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
                                             "KHR_texture_transform"};

constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

struct Parts {
  std::span<const std::uint8_t> json;
  std::span<const std::uint8_t> bin;
  bool binary = false;
};

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

/// The JSON and BIN chunks of a GLB, or the whole file as JSON.
Parts split(std::span<const std::uint8_t> bytes, const std::string& who) {
  if (bytes.size() < 4 || word(bytes, 0) != kGlbMagic) return {bytes, {}, false};
  if (bytes.size() < 20) throw Error(who + ": GLB is cut off in its header");
  if (word(bytes, 4) != 2)
    throw Error(who + ": GLB version " + std::to_string(word(bytes, 4)) + ", must be 2");
  const std::uint32_t length = word(bytes, 8);
  if (length < 20 || length > bytes.size())
    throw Error(who + ": GLB states " + std::to_string(length) + " bytes, the file has " +
                std::to_string(bytes.size()));
  Parts parts;
  parts.binary = true;
  std::size_t at = 12;
  for (int chunk = 0; at + 8 <= length; ++chunk) {
    const std::uint32_t size = word(bytes, at), type = word(bytes, at + 4);
    at += 8;
    if (size > length - at)
      throw Error(who + ": GLB chunk " + std::to_string(chunk) + " reaches beyond the file");
    if (chunk == 0 && type != kJsonChunk) throw Error(who + ": GLB does not start with its JSON chunk");
    if (chunk == 0) parts.json = bytes.subspan(at, size);
    if (chunk == 1 && type == kBinChunk) parts.bin = bytes.subspan(at, size);
    at += size;
  }
  return parts;
}

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

Json parseJson(std::span<const std::uint8_t> text, const std::string& who, LoadBudget& budget) {
  budget.charge(text.size(), "JSON");
  budget.charge(countValues(text), kBytesPerJsonValue, "JSON");
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

int base64Value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

Bytes decodeDataUri(const std::string& uri, const std::string& who, LoadBudget& budget) {
  static constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (mark == std::string::npos) throw Error(who + ": data URI is not base64");
  Bytes out;
  budget.charge((uri.size() - mark) * 3 / 4, who);
  out.reserve((uri.size() - mark) * 3 / 4);
  std::uint32_t bits = 0;
  int have = 0;
  for (std::size_t i = mark + kMark.size(); i < uri.size() && uri[i] != '='; ++i) {
    const int value = base64Value(uri[i]);
    if (value < 0) throw Error(who + ": data URI holds a character that is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    have += 6;
    if (have >= 8) out.push_back(static_cast<std::uint8_t>(bits >> (have -= 8)));
  }
  return out;
}

std::string decodePercent(const std::string& uri, const std::string& who) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out.push_back(uri[i]);
      continue;
    }
    const int high = i + 2 < uri.size() ? hex(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex(uri[i + 2]) : -1;
    if (high < 0 || low < 0) throw Error(who + ": URI holds a broken % escape");
    out.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return out;
}

Bytes resolve(const Element& owner, const fs::path& folder, LoadBudget& budget) {
  const std::string uri = owner.text("uri");
  if (uri.starts_with("data:")) return decodeDataUri(uri, owner.path(), budget);
  const std::size_t colon = uri.find(':');
  if (colon != std::string::npos && uri.find('/') > colon)
    owner.refuse("URI has the scheme '" + uri.substr(0, colon) +
                 "'; only data: and files beside the scene are read");
  return readSceneFile(confinedFile(folder, decodePercent(uri, owner.path()), owner.path()), budget);
}

std::vector<Bytes> readBuffers(const Element& root, const Parts& parts, const fs::path& folder,
                               LoadBudget& budget) {
  std::vector<Bytes> out;
  for (const Element& buffer : root.array("buffers")) {
    const std::uint64_t length = buffer.integer("byteLength", 1, kMaxSceneBytes);
    Bytes bytes;
    if (buffer.has("uri")) {
      bytes = resolve(buffer, folder, budget);
    } else if (out.empty() && parts.binary) {
      budget.charge(parts.bin.size(), buffer.path());
      bytes.assign(parts.bin.begin(), parts.bin.end());
    } else {
      buffer.refuse("has neither a URI nor the file's binary chunk");
    }
    if (bytes.size() < length)
      buffer.refuse("states " + std::to_string(length) + " bytes, has " + std::to_string(bytes.size()));
    bytes.resize(static_cast<std::size_t>(length));
    out.push_back(std::move(bytes));
  }
  return out;
}

Bytes imageBytes(const Element& root, const Element& image, const std::vector<Bytes>& buffers,
                 const fs::path& folder, LoadBudget& budget) {
  if (image.has("uri") == image.has("bufferView")) image.refuse("must have either 'uri' or 'bufferView'");
  if (image.has("uri")) return resolve(image, folder, budget);
  const auto views = root.array("bufferViews");
  const Element& view = views[image.index("bufferView", views.size(), "bufferViews")];
  const Bytes& buffer = buffers[view.index("buffer", buffers.size(), "buffers")];
  const auto from =
      buffer.begin() + static_cast<std::ptrdiff_t>(view.integerOr("byteOffset", 0, 0, buffer.size()));
  const std::uint64_t length = view.integer("byteLength", 1, buffer.size());
  budget.charge(length, image.path());
  return Bytes(from, from + static_cast<std::ptrdiff_t>(length));
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
  const Parts parts = split(bytes, who);
  Json json = parseJson(parts.json, who, budget);
  const Element root(json, who);
  GatedGltf out;
  Repairs repairs;
  checkVersion(root);
  checkSchema(json, who, repairs);
  checkAsset(root, kSupportedExtensions, out.warnings);
  const fs::path folder = file.parent_path();
  out.buffers = readBuffers(root, parts, folder, budget);
  const std::vector<GltfAccessor> accessors = checkAccessors(root, out.buffers);
  checkReferences(root);
  checkAnimations(json, who, accessors, repairs);
  for (const Element& image : root.array("images"))
    out.images.push_back({image.path(), imageBytes(root, image, out.buffers, folder, budget)});
  repairs.report(out.warnings);
  warnOfWhatIsLeftOut(json, out.warnings);
  out.json = checkedJson(json, out.buffers.size());
  return out;
}

}  // namespace saccade::core
