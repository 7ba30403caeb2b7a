#include "core/scene/export_materials.h"

#include <algorithm>
#include <cmath>

#include "core/content_hash.h"
#include "core/image_io.h"
#include "core/scene/gltf_material_extensions.h"

namespace saccade::core {
namespace {

using nlohmann::json;

constexpr int kNearest = 9728, kLinear = 9729, kLinearMipmapLinear = 9987, kNearestMipmapLinear = 9986;
constexpr int kClampToEdge = 33071, kMirroredRepeat = 33648, kRepeat = 10497;
constexpr float kIorOfReflectsEverything = 1e8f;  // gltf_material_extensions.cpp: the extension's ior 0
constexpr double kNominalThickness = 0.1;  // metres; the scene keeps no more than that walls are not thin

int wrapMode(Wrap wrap) {
  if (wrap == Wrap::clamp) return kClampToEdge;
  return wrap == Wrap::mirror ? kMirroredRepeat : kRepeat;
}

/// Factors in [0, 1] and the strength that KHR_materials_emissive_strength adds.
std::pair<Vec3, float> splitEmission(const Vec3& emission) {
  const float strength = std::max({emission.x, emission.y, emission.z, 1.0f});
  return {emission / strength, strength};
}

json wardExtras(const WardLobe& ward) {
  return {{"diffuse", jsonArray(ward.diffuse)},
          {"specular", jsonArray(ward.specular)},
          {"alpha", {static_cast<double>(ward.alphaX), static_cast<double>(ward.alphaY)}}};
}

/// Viewers that do not know Ward's lobe show a GGX lobe about as wide.
float shownRoughness(const Material& m) {
  return m.ward ? std::min(1.0f, std::sqrt(std::sqrt(2.0f) * std::sqrt(m.ward->alphaX * m.ward->alphaY)))
                : m.roughness;
}

}  // namespace

ExportedUvSets exportedUvSets(const Material& m) {
  bool any0 = false, any1 = false;
  for (const TextureSlot* slot :
       {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissionTexture,
        &m.specularTexture, &m.specularColorTexture, &m.transmissionTexture, &m.clearcoatTexture,
        &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture, &m.anisotropyTexture, &m.sheenColorTexture,
        &m.sheenRoughnessTexture, &m.iridescenceTexture, &m.iridescenceThicknessTexture})
    if (*slot) (slot->uvSet == 0 ? any0 : any1) = true;
  return any1 && !any0 ? ExportedUvSets{2, 0} : ExportedUvSets{};
}

MaterialExporter::MaterialExporter(const Scene& scene, const LightTextures& light, GlbBuilder& glb)
    : scene_(scene), light_(light), glb_(glb) {}

void MaterialExporter::addAll() {
  if (!light_.emission.empty()) {
    emission_ = lightTexture("outgoing light", light_.emission);
    lightmap_ = lightTexture("lightmap", light_.lightmap);
  }
  for (std::size_t i = 0; i < scene_.materials.size(); ++i)
    glb_.root["materials"].push_back(material(scene_.materials[i], light_.materials[i]));
}

json MaterialExporter::material(const Material& m, const MaterialLight& light) {
  json out = json::object();
  if (!m.name.empty()) out["name"] = m.name;
  addCore(m, out);
  addEmission(m, light, out);
  if (m.unlit) extension(out, "KHR_materials_unlit");
  if (m.ward) {
    out["extras"]["saccade"]["ward"] = wardExtras(*m.ward);
    return out;
  }
  addLobes(m, out);
  addVolume(m, out);
  addClearcoat(m, out);
  addAnisotropy(m, out);
  addSheen(m, out);
  addIridescence(m, out);
  return out;
}

void MaterialExporter::addCore(const Material& m, json& out) {
  json& pbr = out["pbrMetallicRoughness"];
  pbr = {{"baseColorFactor", jsonArray(Vec4(m.baseColor, m.alpha))},
         {"metallicFactor", static_cast<double>(m.metallic)},
         {"roughnessFactor", static_cast<double>(shownRoughness(m))}};
  put(pbr, "baseColorTexture", m, m.baseColorTexture);
  put(pbr, "metallicRoughnessTexture", m, m.metallicRoughnessTexture);
  put(out, "normalTexture", m, m.normalTexture);
  if (m.normalTexture) out["normalTexture"]["scale"] = static_cast<double>(m.normalScale);
  if (m.alphaMode == AlphaMode::blend) out["alphaMode"] = "BLEND";
  if (m.alphaMode == AlphaMode::mask) {
    out["alphaMode"] = "MASK";
    out["alphaCutoff"] = static_cast<double>(m.alphaCutoff);
  }
  if (m.doubleSided) out["doubleSided"] = true;
}

void MaterialExporter::addEmission(const Material& m, const MaterialLight& light, json& out) {
  const auto put3 = [&](const Vec3& emission) {
    const auto [factor, strength] = splitEmission(emission);
    if (factor != Vec3(0)) out["emissiveFactor"] = jsonArray(factor);
    if (strength > 1)
      extension(out, "KHR_materials_emissive_strength")["emissiveStrength"] = static_cast<double>(strength);
  };
  if (light.irradiance == 0) {
    put3(m.emission);
    put(out, "emissiveTexture", m, m.emissionTexture);
    return;
  }
  put3(Vec3(light.radiance));
  out["emissiveTexture"] = {{"index", emission_}, {"texCoord", 1}};
  const json lightmap = {
      {"index", lightmap_}, {"texCoord", 1}, {"intensity", static_cast<double>(light.irradiance)}};
  extension(out, "MOZ_lightmap") = lightmap;
  out["extras"]["saccade"]["lightmap"] = lightmap;
  json& own = extension(out, kOwnEmissionExtension);
  own["emissiveFactor"] = jsonArray(m.emission);
  put(own, "emissiveTexture", m, m.emissionTexture);
}

void MaterialExporter::addLobes(const Material& m, json& out) {
  if (m.ior != 1.5f)
    extension(out, "KHR_materials_ior")["ior"] =
        m.ior >= kIorOfReflectsEverything ? 0.0 : static_cast<double>(m.ior);
  if (m.specular != 1 || m.specularColor != Vec3(1) || m.specularTexture || m.specularColorTexture) {
    json& e = extension(out, "KHR_materials_specular");
    e["specularFactor"] = static_cast<double>(m.specular);
    // Blender 3.4 reads the colour and not the factor.
    e["specularColorFactor"] = jsonArray(m.specular == 0 ? Vec3(0) : m.specularColor);
    put(e, "specularTexture", m, m.specularTexture);
    put(e, "specularColorTexture", m, m.specularColorTexture);
  }
  if (m.transmission > 0) {
    json& e = extension(out, "KHR_materials_transmission");
    e["transmissionFactor"] = static_cast<double>(m.transmission);
    put(e, "transmissionTexture", m, m.transmissionTexture);
  }
}

void MaterialExporter::addVolume(const Material& m, json& out) {
  if (m.dispersion > 0)
    extension(out, "KHR_materials_dispersion")["dispersion"] = static_cast<double>(m.dispersion);
  if (!m.thinWalled && m.attenuationDistance == kInfinity && m.dispersion == 0) return;
  json& e = extension(out, "KHR_materials_volume");
  e["thicknessFactor"] = m.thinWalled ? 0.0 : kNominalThickness;
  e["attenuationColor"] = jsonArray(m.attenuationColor);
  if (m.attenuationDistance < kInfinity)
    e["attenuationDistance"] = static_cast<double>(m.attenuationDistance);
}

void MaterialExporter::addClearcoat(const Material& m, json& out) {
  if (m.clearcoat == 0) return;
  json& e = extension(out, "KHR_materials_clearcoat");
  e["clearcoatFactor"] = static_cast<double>(m.clearcoat);
  e["clearcoatRoughnessFactor"] = static_cast<double>(m.clearcoatRoughness);
  put(e, "clearcoatTexture", m, m.clearcoatTexture);
  put(e, "clearcoatRoughnessTexture", m, m.clearcoatRoughnessTexture);
  put(e, "clearcoatNormalTexture", m, m.clearcoatNormalTexture);
  if (m.clearcoatNormalTexture)
    e["clearcoatNormalTexture"]["scale"] = static_cast<double>(m.clearcoatNormalScale);
}

void MaterialExporter::addAnisotropy(const Material& m, json& out) {
  if (m.anisotropy == 0) return;
  json& e = extension(out, "KHR_materials_anisotropy");
  e["anisotropyStrength"] = static_cast<double>(m.anisotropy);
  e["anisotropyRotation"] = static_cast<double>(m.anisotropyRotation);
  put(e, "anisotropyTexture", m, m.anisotropyTexture);
}

void MaterialExporter::addSheen(const Material& m, json& out) {
  if (m.sheenColor == Vec3(0)) return;
  json& e = extension(out, "KHR_materials_sheen");
  e["sheenColorFactor"] = jsonArray(m.sheenColor);
  e["sheenRoughnessFactor"] = static_cast<double>(m.sheenRoughness);
  put(e, "sheenColorTexture", m, m.sheenColorTexture);
  put(e, "sheenRoughnessTexture", m, m.sheenRoughnessTexture);
}

void MaterialExporter::addIridescence(const Material& m, json& out) {
  if (m.iridescence == 0) return;
  json& e = extension(out, "KHR_materials_iridescence");
  e["iridescenceFactor"] = static_cast<double>(m.iridescence);
  e["iridescenceIor"] = static_cast<double>(m.iridescenceIor);
  e["iridescenceThicknessMinimum"] = static_cast<double>(m.iridescenceThicknessMin);
  e["iridescenceThicknessMaximum"] = static_cast<double>(m.iridescenceThicknessMax);
  put(e, "iridescenceTexture", m, m.iridescenceTexture);
  put(e, "iridescenceThicknessTexture", m, m.iridescenceThicknessTexture);
}

json& MaterialExporter::extension(json& material, const char* name) {
  glb_.useExtension(name);
  json& e = material["extensions"][name];
  if (e.is_null()) e = json::object();
  return e;
}

void MaterialExporter::put(json& object, const char* key, const Material& m, const TextureSlot& slot) {
  if (!slot) return;
  json info = {{"index", texture(slot.texture)}};
  const ExportedUvSets sets = exportedUvSets(m);
  if (const int set = slot.uvSet == 0 ? sets.of0 : sets.of1; set != 0) info["texCoord"] = set;
  if (slot.transformed()) {
    glb_.useExtension("KHR_texture_transform");
    info["extensions"]["KHR_texture_transform"] = {{"offset", jsonArray(slot.offset)},
                                                   {"rotation", static_cast<double>(slot.rotation)},
                                                   {"scale", jsonArray(slot.scale)}};
  }
  object[key] = std::move(info);
}

int MaterialExporter::texture(int sceneTexture) {
  const auto [at, isNew] = textures_.try_emplace(sceneTexture, 0);
  if (!isNew) return at->second;
  const Texture& from = scene_.textures[static_cast<std::size_t>(sceneTexture)];
  json& textures = glb_.root["textures"];
  textures.push_back({{"sampler", sampler(from)}, {"source", image(from.name, from.image)}});
  return at->second = static_cast<int>(textures.size()) - 1;
}

int MaterialExporter::sampler(const Texture& from) {
  json& samplers = glb_.root["samplers"];
  const auto [at, isNew] =
      samplers_.try_emplace({from.wrapS, from.wrapT, from.nearest}, static_cast<int>(samplers.size()));
  if (isNew)
    samplers.push_back({{"magFilter", from.nearest ? kNearest : kLinear},
                        {"minFilter", from.nearest ? kNearestMipmapLinear : kLinearMipmapLinear},
                        {"wrapS", wrapMode(from.wrapS)},
                        {"wrapT", wrapMode(from.wrapT)}});
  return at->second;
}

/// The scene has an image twice where it is read as colour and as numbers: the file has it once.
int MaterialExporter::image(const std::string& name, const ImageRgba8& pixels) {
  ContentHash hash;
  hash.add(pixels.width());
  hash.addArray(pixels.pixels());
  const auto [at, isNew] = images_.try_emplace(hash.value(), 0);
  if (isNew) at->second = glb_.addImage(name, encodePng(pixels), "image/png");
  return at->second;
}

/// Without mipmaps, which would mix charts that lie side by side.
int MaterialExporter::lightTexture(const std::string& name, const ImageRgba8& pixels) {
  json &samplers = glb_.root["samplers"], &textures = glb_.root["textures"];
  samplers.push_back(
      {{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}});
  textures.push_back({{"name", name}, {"sampler", samplers.size() - 1}, {"source", image(name, pixels)}});
  return static_cast<int>(textures.size()) - 1;
}

}  // namespace saccade::core
