#include "data/make_scenes/glb_writer.h"

#include <algorithm>
#include <cmath>

#include "core/image_io.h"

namespace saccade::data {
namespace {

using nlohmann::json;

/// Six decimals: enough for metres and colours, and short.
double tidy(float x) { return std::round(static_cast<double>(x) * 1e6) / 1e6; }
json tidyArray(const Vec3& v) { return {tidy(v.x), tidy(v.y), tidy(v.z)}; }

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

}  // namespace

Placement standing(const Vec3& translation, float degrees, float scale) {
  return {translation, glm::angleAxis(glm::radians(degrees), Vec3(0, 1, 0)), Vec3(scale)};
}

int GlbWriter::addImage(const std::string& name, std::vector<std::uint8_t> file, const char* mimeType) {
  const int image = glb_.addImage(name, std::move(file), mimeType);
  glb_.root["textures"].push_back({{"sampler", 0}, {"source", image}});
  return image;
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
  for (const auto& item : extensions.items()) glb_.useExtension(item.key());
  if (!extensions.empty()) material["extensions"] = extensions;
  if (m.ward) material["extras"] = extrasOf(*m.ward);
  glb_.root["materials"].push_back(material);
  const bool anisotropic = m.ward && m.ward->alphaX != m.ward->alphaY;
  isBumpy_.push_back(m.normalTexture >= 0 || anisotropic);
  isTextured_.push_back(anisotropic ||
                        std::max({m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture}) >= 0);
  return static_cast<int>(glb_.root["materials"].size()) - 1;
}

int GlbWriter::addGeometry(const MeshData& mesh, bool textured, bool bumpy) {
  json attributes = {{"POSITION", glb_.addPositions(mesh.positions)},
                     {"NORMAL", glb_.addNormals(mesh.normals)}};
  if (textured || bumpy) attributes["TEXCOORD_0"] = glb_.addUvs(mesh.uvs);
  if (bumpy) attributes["TANGENT"] = glb_.addVec4s(tangentsOf(mesh));
  primitives_.push_back(
      {{"attributes", attributes}, {"indices", glb_.addIndices(mesh.indices, mesh.positions.size())}});
  return static_cast<int>(primitives_.size()) - 1;
}

void GlbWriter::addNode(const std::string& name, int geometry, int material, const Placement& placement) {
  json& meshes = glb_.root["meshes"];
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
  glb_.root["nodes"].push_back(node);
}

void GlbWriter::addCamera(const core::Camera& camera) {
  constexpr double kNearMetres = 0.05, kFarMetres = 100;
  glb_.root["cameras"].push_back(
      {{"name", camera.name},
       {"type", "perspective"},
       {"perspective",
        {{"yfov", tidy(glm::radians(camera.fovYDegrees))}, {"znear", kNearMetres}, {"zfar", kFarMetres}}}});
  const glm::quat q = glm::quatLookAt(glm::normalize(camera.at - camera.eye), camera.up);
  glb_.root["nodes"].push_back({{"name", camera.name},
                                {"camera", glb_.root["cameras"].size() - 1},
                                {"translation", tidyArray(camera.eye)},
                                {"rotation", {tidy(q.x), tidy(q.y), tidy(q.z), tidy(q.w)}}});
}

std::vector<std::uint8_t> GlbWriter::bytes() const {
  core::GlbBuilder whole = glb_;
  if (whole.root.contains("textures"))
    whole.root["samplers"] =
        json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
  json nodes = json::array();
  for (std::size_t i = 0; i < whole.root["nodes"].size(); ++i) nodes.push_back(i);
  whole.root["scenes"] = json::array({{{"nodes", nodes}}});
  whole.root["scene"] = 0;
  return whole.bytes("Saccade make_scenes");
}

}  // namespace saccade::data
