// The textures of a glTF file, as its materials ask for them.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "core/scene/gltf_gate.h"
#include "core/scene/repairs.h"
#include "core/scene/scene.h"
#include "core/scene/tinygltf.h"

namespace saccade::core {

/// Fills scene.textures with those that are used, one per texture and colour space. Every function throws
/// core::Error for an image that cannot be decoded. What it refers to must outlive it.
class GltfTextures {
 public:
  GltfTextures(const tinygltf::Model& model, const std::vector<EncodedImage>& images, Scene& scene,
               Repairs& repairs, LoadBudget& budget)
      : model_(model), images_(images), scene_(scene), repairs_(repairs), budget_(budget) {}

  /// The slot of glTF's own texture infos, KHR_texture_transform included. An index of -1, a UV set above 1
  /// and a texture without PNG or JPEG give an empty slot; the latter two are counted in `repairs`.
  template <class Info>  // tinygltf::TextureInfo or NormalTextureInfo
  TextureSlot slot(const Info& info, bool srgb) {
    const auto at = info.extensions.find(kTransform);
    return make({info.index, info.texCoord, at == info.extensions.end() ? nullptr : &at->second},
                {srgb, kNotGlossiness});
  }
  /// The same of the member `key` of a material extension; absent: empty.
  TextureSlot slot(const tinygltf::Value& extension, const char* key, bool srgb) {
    return make(reference(extension, key), {srgb, kNotGlossiness});
  }
  /// A metallic-roughness texture made of the alpha channel: G = 1 - factor * A, B = 0 (8 bits).
  TextureSlot roughnessFromGlossiness(const tinygltf::Value& extension, const char* key, float factor) {
    return make(reference(extension, key), {false, factor});
  }

 private:
  static constexpr const char* kTransform = "KHR_texture_transform";
  static constexpr float kNotGlossiness = -1;
  struct Reference {
    int index = -1;
    int uvSet = 0;
    const tinygltf::Value* transform = nullptr;
  };
  /// How the texels are to be read: srgb, and the glossiness factor or kNotGlossiness.
  using Reading = std::pair<bool, float>;

  static Reference reference(const tinygltf::Value& extension, const char* key);
  TextureSlot make(const Reference& from, const Reading& reading);
  Texture texture(const tinygltf::Texture& from, const Reading& reading);

  const tinygltf::Model& model_;
  const std::vector<EncodedImage>& images_;
  Scene& scene_;
  Repairs& repairs_;
  LoadBudget& budget_;
  std::map<std::pair<int, Reading>, int> made_;  ///< (glTF texture, reading) -> scene texture
  std::map<int, ImageRgba8> decoded_;            ///< by glTF image
};

}  // namespace saccade::core
