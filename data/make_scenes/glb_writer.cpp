#include "data/make_scenes/glb_writer.h"

#include <algorithm>
#include <cmath>

#include "core/image_io.h"

namespace saccade::data {
namespace {

using nlohmann::json;

constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr std::size_t kMaxShortVertices = 65535;  // index 65535 is reserved for primitive restart

/// Six decimals: enough for metres and colours, and short.
double tidy(float x) { return std::round(static_cast<double>(x) * 1e6) / 1e6; }
json tidyArray(const Vec3& v) { return {tidy(v.x), tidy(v.y), tidy(v.z)}; }
json exactArray(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

json textureInfo(int texture) { return {{"index", texture}}; }

json pbrOf(const MaterialDesc& m) {
  json pbr = {{"metallicFactor", tidy(m.metallic)}, {"roughnessFactor", tidy(m.roughness)}};
  if (m.baseColor != Vec3(1))
    pbr["baseColorFactor"] = {tidy(m.baseColor.x), tidy(m.baseColor.y), tidy(m.baseColor.z), 1.0};
  if (m.baseColorTexture >= 0) pbr["baseColorTexture"] = textureInfo(m.baseColorTexture);
  if (m.metallicRoughnessTexture >= 0)
    pbr["metallicRoughnessTexture"] = textureInfo(m.metallicRoughnessTexture);
  return pbr;
}

json extensionsOf(const MaterialDesc& m, float emissiveStrength) {
  json extensions = json::object();
  if (m.transmission > 0)
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", tidy(m.transmission)}};
  if (m.ior != 1.5f) extensions["KHR_materials_ior"] = {{"ior", tidy(m.ior)}};
  if (m.specular != 1) extensions["KHR_materials_specular"] = {{"specularFactor", tidy(m.specular)}};
  if (emissiveStrength > 1)
    extensions["KHR_materials_emissive_strength"] = {{"emissiveStrength", tidy(emissiveStrength)}};
  return extensions;
}

json extrasOf(const core::WardLobe& ward) {
  const json lobe = {{"diffuse", tidyArray(ward.diffuse)},
                     {"specular", tidyArray(ward.specular)},
                     {"alpha", {tidy(ward.alphaX), tidy(ward.alphaY)}}};
  return {{"saccade", {{"ward", lobe}}}};
}

void pad(std::vector<std::uint8_t>& bytes, std::uint8_t with) {
  while (bytes.size() % 4 != 0) bytes.push_back(with);
}

void append32(std::vector<std::uint8_t>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

Placement standing(const Vec3& translation, float degrees, float scale) {
  return {translation, glm::angleAxis(glm::radians(degrees), Vec3(0, 1, 0)), Vec3(scale)};
}

int GlbWriter::addImage(const std::string& name, const std::vector<std::uint8_t>& file,
                        const char* mimeType) {
  imageFiles_.push_back(file);
  json& images = root_["images"];
  images.push_back({{"name", name}, {"mimeType", mimeType}});
  root_["textures"].push_back({{"sampler", 0}, {"source", images.size() - 1}});
  return static_cast<int>(images.size()) - 1;
}

int GlbWriter::addJpeg(const std::string& name, const core::ImageRgba8& image, int quality) {
  return addImage(name, core::encodeJpeg(image, quality), "image/jpeg");
}

int GlbWriter::addPng(const std::string& name, const core::ImageRgba8& image) {
  return addImage(name, core::encodePng(image), "image/png");
}

int GlbWriter::addMaterial(const MaterialDesc& m) {
  json material = {{"name", m.name}, {"pbrMetallicRoughness", pbrOf(m)}};
  if (m.doubleSided) material["doubleSided"] = true;
  if (m.normalTexture >= 0) {
    material["normalTexture"] = textureInfo(m.normalTexture);
    if (m.normalScale != 1) material["normalTexture"]["scale"] = tidy(m.normalScale);
  }
  const float strength = std::max({m.emission.x, m.emission.y, m.emission.z, 1.f});
  if (m.emission != Vec3(0)) material["emissiveFactor"] = tidyArray(m.emission / strength);
  const json extensions = extensionsOf(m, strength);
  for (const auto& item : extensions.items()) extensionsUsed_[item.key()] = true;
  if (!extensions.empty()) material["extensions"] = extensions;
  if (m.ward) material["extras"] = extrasOf(*m.ward);
  root_["materials"].push_back(material);
  const bool anisotropic = m.ward && m.ward->alphaX != m.ward->alphaY;
  isBumpy_.push_back(m.normalTexture >= 0 || anisotropic);
  isTextured_.push_back(anisotropic ||
                        std::max({m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture}) >= 0);
  return static_cast<int>(root_["materials"].size()) - 1;
}

int GlbWriter::addAccessor(StreamKind kind, const char* type, int componentType, std::size_t count,
                           const void* data, std::size_t byteCount) {
  std::vector<std::uint8_t>& stream = streams_[kind].data;
  root_["accessors"].push_back({{"bufferView", kind},
                                {"byteOffset", stream.size()},
                                {"componentType", componentType},
                                {"count", count},
                                {"type", type}});
  const auto* first = static_cast<const std::uint8_t*>(data);
  stream.insert(stream.end(), first, first + byteCount);
  return static_cast<int>(root_["accessors"].size()) - 1;
}

int GlbWriter::addIndices(const MeshData& mesh) {
  if (mesh.positions.size() > kMaxShortVertices)
    return addAccessor(kLongIndices, "SCALAR", kUnsignedInt, mesh.indices.size(), mesh.indices.data(),
                       mesh.indices.size() * sizeof(std::uint32_t));
  const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
  return addAccessor(kShortIndices, "SCALAR", kUnsignedShort, narrow.size(), narrow.data(),
                     narrow.size() * sizeof(std::uint16_t));
}

int GlbWriter::addGeometry(const MeshData& mesh, bool textured, bool bumpy) {
  core::Bounds bounds;
  for (const Vec3& p : mesh.positions) bounds.add(p);
  const std::size_t count = mesh.positions.size();
  json attributes;
  attributes["POSITION"] =
      addAccessor(kPositions, "VEC3", kFloat, count, mesh.positions.data(), count * sizeof(Vec3));
  root_["accessors"].back()["min"] = exactArray(bounds.lo);
  root_["accessors"].back()["max"] = exactArray(bounds.hi);
  attributes["NORMAL"] =
      addAccessor(kNormals, "VEC3", kFloat, count, mesh.normals.data(), count * sizeof(Vec3));
  if (textured || bumpy)
    attributes["TEXCOORD_0"] =
        addAccessor(kUvs, "VEC2", kFloat, count, mesh.uvs.data(), count * sizeof(Vec2));
  if (bumpy) {
    const std::vector<Vec4> tangents = tangentsOf(mesh);
    attributes["TANGENT"] =
        addAccessor(kTangents, "VEC4", kFloat, count, tangents.data(), count * sizeof(Vec4));
  }
  primitives_.push_back({{"attributes", attributes}, {"indices", addIndices(mesh)}});
  return static_cast<int>(primitives_.size()) - 1;
}

void GlbWriter::addNode(const std::string& name, int geometry, int material, const Placement& placement) {
  json& meshes = root_["meshes"];
  const auto [entry, isNew] = meshes_.try_emplace({geometry, material}, static_cast<int>(meshes.size()));
  if (isNew) {
    json primitive = primitives_[static_cast<std::size_t>(geometry)];
    primitive["material"] = material;
    if (!isTextured_[static_cast<std::size_t>(material)]) primitive["attributes"].erase("TEXCOORD_0");
    if (!isBumpy_[static_cast<std::size_t>(material)]) primitive["attributes"].erase("TANGENT");
    meshes.push_back({{"primitives", json::array({primitive})}});
  }
  json node = {{"name", name}, {"mesh", entry->second}};
  if (placement.translation != Vec3(0)) node["translation"] = tidyArray(placement.translation);
  const glm::quat q = glm::normalize(placement.rotation);
  if (q != glm::quat(1, 0, 0, 0)) node["rotation"] = {tidy(q.x), tidy(q.y), tidy(q.z), tidy(q.w)};
  if (placement.scale != Vec3(1)) node["scale"] = tidyArray(placement.scale);
  root_["nodes"].push_back(node);
}

void GlbWriter::addCamera(const core::Camera& camera) {
  constexpr double kNearMetres = 0.05, kFarMetres = 100;
  root_["cameras"].push_back(
      {{"name", camera.name},
       {"type", "perspective"},
       {"perspective",
        {{"yfov", tidy(glm::radians(camera.fovYDegrees))}, {"znear", kNearMetres}, {"zfar", kFarMetres}}}});
  const glm::quat q = glm::quatLookAt(glm::normalize(camera.at - camera.eye), camera.up);
  root_["nodes"].push_back({{"name", camera.name},
                            {"camera", root_["cameras"].size() - 1},
                            {"translation", tidyArray(camera.eye)},
                            {"rotation", {tidy(q.x), tidy(q.y), tidy(q.z), tidy(q.w)}}});
}

json GlbWriter::withBufferViews(std::vector<std::uint8_t>& binary) const {
  json root = root_;
  json views = json::array();
  const auto addView = [&](const std::vector<std::uint8_t>& data) -> json& {
    views.push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", data.size()}});
    binary.insert(binary.end(), data.begin(), data.end());
    pad(binary, 0);
    return views.back();
  };
  int viewOfStream[kStreamKinds] = {};
  for (int kind = 0; kind < kStreamKinds; ++kind) {
    if (streams_[kind].data.empty()) continue;
    viewOfStream[kind] = static_cast<int>(views.size());
    json& view = addView(streams_[kind].data);
    view["target"] = streams_[kind].target;
    if (streams_[kind].stride > 0) view["byteStride"] = streams_[kind].stride;
  }
  for (json& accessor : root["accessors"])
    accessor["bufferView"] = viewOfStream[accessor["bufferView"].get<int>()];
  for (std::size_t i = 0; i < imageFiles_.size(); ++i) {
    root["images"][i]["bufferView"] = views.size();
    addView(imageFiles_[i]);
  }
  root["bufferViews"] = views;
  root["buffers"] = json::array({{{"byteLength", binary.size()}}});
  return root;
}

std::vector<std::uint8_t> GlbWriter::bytes() const {
  constexpr std::size_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  std::vector<std::uint8_t> binary;
  json root = withBufferViews(binary);
  root["asset"] = {{"version", "2.0"}, {"generator", "Saccade make_scenes"}};
  if (!imageFiles_.empty())
    root["samplers"] =
        json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
  for (const auto& [name, used] : extensionsUsed_) root["extensionsUsed"].push_back(name);
  json nodes = json::array();
  for (std::size_t i = 0; i < root["nodes"].size(); ++i) nodes.push_back(i);
  root["scenes"] = json::array({{{"nodes", nodes}}});
  root["scene"] = 0;
  const std::string text = root.dump();
  std::vector<std::uint8_t> jsonChunk(text.begin(), text.end());
  pad(jsonChunk, ' ');

  std::vector<std::uint8_t> file;
  append32(file, kMagic);
  append32(file, kVersion);
  append32(file, 12 + 8 + jsonChunk.size() + 8 + binary.size());
  append32(file, jsonChunk.size());
  append32(file, kJsonChunk);
  file.insert(file.end(), jsonChunk.begin(), jsonChunk.end());
  append32(file, binary.size());
  append32(file, kBinaryChunk);
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

}  // namespace saccade::data
