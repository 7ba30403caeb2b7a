#include "core/scene/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/image_io.h"

namespace saccade::core {
namespace {

constexpr float kLargestIor = 100;

class Converter {
 public:
  Converter(const tinygltf::Model& model, const std::vector<EncodedImage>& images, Scene& scene)
      : model_(model), images_(images), scene_(scene) {}

  void run() {
    for (const tinygltf::Material& m : model_.materials) scene_.materials.push_back(convert(m));
    if (someWithoutMaterial()) {
      Material standard;
      standard.name = "glTF default";
      scene_.materials.push_back(standard);
    }
    if (clamped_ > 0)
      scene_.warnings.push_back(std::to_string(clamped_) + " material factors out of range were clamped");
    if (extraSets_ > 0)
      scene_.warnings.push_back(std::to_string(extraSets_) +
                                " textures use a UV set above 1 and are left out");
    if (sourceless_ > 0)
      scene_.warnings.push_back(std::to_string(sourceless_) +
                                " textures have no PNG or JPEG image and are left out");
  }

 private:
  bool someWithoutMaterial() const {
    for (const tinygltf::Mesh& mesh : model_.meshes)
      for (const tinygltf::Primitive& p : mesh.primitives)
        if (p.material < 0) return true;
    return false;
  }

  /// Into [lo, hi]; what was outside or not a number is counted.
  float within(double value, float lo, float hi, float otherwise) {
    const float x = static_cast<float>(value);
    if (x >= lo && x <= hi) return x;
    ++clamped_;
    return std::isnan(x) ? otherwise : std::clamp(x, lo, hi);
  }

  TextureSlot slot(int index, int uvSet, bool srgb) {
    if (index < 0) return {};
    if (uvSet > 1) {
      ++extraSets_;
      return {};
    }
    if (model_.textures[static_cast<std::size_t>(index)].source < 0) {
      ++sourceless_;
      return {};
    }
    const auto [at, isNew] = made_.try_emplace({index, srgb}, static_cast<int>(scene_.textures.size()));
    if (isNew) scene_.textures.push_back(texture(model_.textures[static_cast<std::size_t>(index)], srgb));
    return {at->second, uvSet};
  }

  TextureSlot slot(const tinygltf::TextureInfo& info, bool srgb) {
    return slot(info.index, info.texCoord, srgb);
  }

  TextureSlot slot(const tinygltf::Value& extension, const char* key, bool srgb) {
    if (!extension.Has(key)) return {};
    const tinygltf::Value& info = extension.Get(key);
    const int uvSet = info.Has("texCoord") ? info.Get("texCoord").GetNumberAsInt() : 0;
    return slot(info.Get("index").GetNumberAsInt(), uvSet, srgb);
  }

  Texture texture(const tinygltf::Texture& from, bool srgb) {
    const EncodedImage& encoded = images_[static_cast<std::size_t>(from.source)];
    auto decoded = decoded_.find(from.source);
    if (decoded == decoded_.end())
      decoded = decoded_.emplace(from.source, decodeImage(encoded.bytes, encoded.name)).first;
    Texture out;
    out.name = encoded.name;
    out.image = decoded->second;
    out.srgb = srgb;
    if (from.sampler < 0) return out;
    const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(from.sampler)];
    const auto wrap = [](int mode) {
      if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
      return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
    };
    out.wrapS = wrap(sampler.wrapS);
    out.wrapT = wrap(sampler.wrapT);
    out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    return out;
  }

  Material convert(const tinygltf::Material& from) {
    Material m;
    m.name = from.name;
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() == 4) {
      for (int c = 0; c < 3; ++c)
        m.baseColor[c] = within(pbr.baseColorFactor[static_cast<std::size_t>(c)], 0, 1, 1);
      m.alpha = within(pbr.baseColorFactor[3], 0, 1, 1);
    }
    m.baseColorTexture = slot(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, true);
    m.metallic = within(pbr.metallicFactor, 0, 1, 1);
    m.roughness = within(pbr.roughnessFactor, 0, 1, 1);
    m.metallicRoughnessTexture = slot(pbr.metallicRoughnessTexture, false);
    m.normalTexture = slot(from.normalTexture.index, from.normalTexture.texCoord, false);
    m.normalScale = static_cast<float>(from.normalTexture.scale);
    if (!std::isfinite(m.normalScale)) m.normalScale = 1;
    if (from.emissiveFactor.size() == 3)
      for (int c = 0; c < 3; ++c)
        m.emission[c] = within(from.emissiveFactor[static_cast<std::size_t>(c)], 0, 1, 0);
    m.emissionTexture = slot(from.emissiveTexture, true);
    if (from.alphaMode == "MASK") m.alphaMode = AlphaMode::mask;
    if (from.alphaMode == "BLEND") m.alphaMode = AlphaMode::blend;
    m.alphaCutoff = static_cast<float>(from.alphaCutoff);
    m.doubleSided = from.doubleSided;
    extensions(from.extensions, m);
    return m;
  }

  double number(const tinygltf::Value& extension, const char* key, double otherwise) const {
    return extension.Has(key) ? extension.Get(key).GetNumberAsDouble() : otherwise;
  }

  void extensions(const tinygltf::ExtensionMap& all, Material& m) {
    const auto find = [&](const char* name) {
      const auto at = all.find(name);
      return at == all.end() ? nullptr : &at->second;
    };
    m.unlit = find("KHR_materials_unlit") != nullptr;
    if (const auto* e = find("KHR_materials_transmission")) {
      m.transmission = within(number(*e, "transmissionFactor", 0), 0, 1, 0);
      m.transmissionTexture = slot(*e, "transmissionTexture", false);
    }
    if (const auto* e = find("KHR_materials_ior")) {
      // 0 is the extension's switch for "F0 = 1 always"; a very large index is the same picture.
      const double ior = number(*e, "ior", 1.5);
      m.ior = ior == 0 ? kLargestIor : within(ior, 1, kLargestIor, 1.5f);
    }
    if (const auto* e = find("KHR_materials_specular")) {
      m.specular = within(number(*e, "specularFactor", 1), 0, 1, 1);
      m.specularTexture = slot(*e, "specularTexture", false);
      m.specularColorTexture = slot(*e, "specularColorTexture", true);
      if (e->Has("specularColorFactor"))
        for (int c = 0; c < 3; ++c)
          m.specularColor[c] = within(e->Get("specularColorFactor").Get(c).GetNumberAsDouble(), 0, 1e6f, 1);
    }
    if (const auto* e = find("KHR_materials_emissive_strength"))
      m.emission *= within(number(*e, "emissiveStrength", 1), 0, 1e12f, 1);
  }

  const tinygltf::Model& model_;
  const std::vector<EncodedImage>& images_;
  Scene& scene_;
  std::map<std::pair<int, bool>, int> made_;  ///< (glTF texture, sRGB) -> scene texture
  std::map<int, ImageRgba8> decoded_;         ///< by glTF image
  int clamped_ = 0, extraSets_ = 0, sourceless_ = 0;
};

}  // namespace

void convertMaterials(const tinygltf::Model& model, const std::vector<EncodedImage>& images, Scene& scene) {
  Converter(model, images, scene).run();
}

}  // namespace saccade::core
