// Materials and textures of an exported scene: the inverse of gltf_materials.h.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>

#include "core/scene/export_gltf.h"
#include "core/scene/glb_builder.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// Where an exported primitive has the scene's UV sets: 1 is the atlas.
struct ExportedUvSets {
  int of0 = 0;
  int of1 = 2;
};
/// A material that uses the second set alone has it as TEXCOORD_0: loaders that know two sets read it.
ExportedUvSets exportedUvSets(const Material& material);

/// Writes textures as they are first used. What it refers to must outlive it.
class MaterialExporter {
 public:
  MaterialExporter(const Scene& scene, const LightTextures& light, GlbBuilder& glb);
  /// All of the scene's, index by index, into root["materials"].
  void addAll();

 private:
  nlohmann::json material(const Material& m, const MaterialLight& light);
  void addCore(const Material& m, nlohmann::json& out);
  void addEmission(const Material& m, const MaterialLight& light, nlohmann::json& out);
  void addLobes(const Material& m, nlohmann::json& out);
  void addVolume(const Material& m, nlohmann::json& out);
  void addClearcoat(const Material& m, nlohmann::json& out);
  void addAnisotropy(const Material& m, nlohmann::json& out);
  void addSheen(const Material& m, nlohmann::json& out);
  void addIridescence(const Material& m, nlohmann::json& out);

  nlohmann::json& extension(nlohmann::json& material, const char* name);
  /// Sets `object`[key] where the slot has a texture.
  void put(nlohmann::json& object, const char* key, const Material& m, const TextureSlot& slot);
  int texture(int sceneTexture);
  int sampler(const Texture& texture);
  int image(const std::string& name, const ImageRgba8& pixels);
  int lightTexture(const std::string& name, const ImageRgba8& pixels);

  const Scene& scene_;
  const LightTextures& light_;
  GlbBuilder& glb_;
  std::map<int, int> textures_;  ///< scene texture -> glTF texture
  std::map<std::tuple<Wrap, Wrap, bool>, int> samplers_;
  std::map<std::uint64_t, int> images_;  ///< hash of the pixels -> glTF image
  int emission_ = -1, lightmap_ = -1;    ///< glTF textures
};

}  // namespace saccade::core
