#include "core/scene/gltf_materials.h"

#include <filesystem>

#include "core/scene/gltf_material_extensions.h"
#include "core/scene/gltf_textures.h"
#include "core/scene/repairs.h"

namespace saccade::core {
namespace {

bool someWithoutMaterial(const tinygltf::Model& model) {
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& p : mesh.primitives)
      if (p.material < 0) return true;
  return false;
}

/// glTF 2.0 without extensions.
Material coreMaterial(const tinygltf::Material& from, MaterialContext& c) {
  Material m;
  m.name = from.name;
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  if (pbr.baseColorFactor.size() == 4) {
    for (int i = 0; i < 3; ++i)
      m.baseColor[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    m.alpha = static_cast<float>(pbr.baseColorFactor[3]);
  }
  m.baseColorTexture = c.textures.slot(pbr.baseColorTexture, true);
  m.metallic = static_cast<float>(pbr.metallicFactor);
  m.roughness = static_cast<float>(pbr.roughnessFactor);
  m.metallicRoughnessTexture = c.textures.slot(pbr.metallicRoughnessTexture, false);
  m.normalTexture = c.textures.slot(from.normalTexture, false);
  m.normalScale = static_cast<float>(from.normalTexture.scale);
  if (from.emissiveFactor.size() == 3)
    for (int i = 0; i < 3; ++i)
      m.emission[i] = static_cast<float>(from.emissiveFactor[static_cast<std::size_t>(i)]);
  if (!from.extensions.contains(kOwnEmissionExtension))
    m.emissionTexture = c.textures.slot(from.emissiveTexture, true);
  if (from.alphaMode == "MASK") m.alphaMode = AlphaMode::mask;
  if (from.alphaMode == "BLEND") m.alphaMode = AlphaMode::blend;
  m.alphaCutoff = static_cast<float>(from.alphaCutoff);
  m.doubleSided = from.doubleSided;
  return m;
}

}  // namespace

void convertMaterials(const tinygltf::Model& model, const std::vector<EncodedImage>& images, float unitScale,
                      Scene& scene, LoadBudget& budget) {
  Repairs repairs;
  GltfTextures textures(model, images, scene, repairs, budget);
  MaterialContext context{textures, repairs, unitScale};
  const std::string file = std::filesystem::path(scene.path).filename().string();
  for (const tinygltf::Material& from : model.materials) {
    Material m = coreMaterial(from, context);
    applyMaterialExtensions(from.extensions, context, m);
    const std::string who = file + ": materials[" + std::to_string(scene.materials.size()) + "]";
    applyWardExtras(from.extras, who, context, m);
    scene.materials.push_back(std::move(m));
  }
  if (someWithoutMaterial(model)) {
    Material standard;
    standard.name = "glTF default";
    scene.materials.push_back(standard);
  }
  repairs.report(scene.warnings);
}

}  // namespace saccade::core
