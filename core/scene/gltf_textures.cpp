#include "core/scene/gltf_textures.h"

#include <cmath>
#include <string>

#include "core/image_io.h"
#include "core/scene/gltf_values.h"

namespace saccade::core {
namespace {

Wrap wrapOf(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

void glossinessToRoughness(ImageRgba8& image, float factor) {
  for (Rgba8& p : image.pixels())
    p = {255, static_cast<std::uint8_t>(std::lround(255 - factor * static_cast<float>(p.a))), 0, 255};
}

void transform(const tinygltf::Value& from, TextureSlot& slot) {
  slot.offset = vectorOr(from, "offset", Vec2(0));
  slot.rotation = numberOr(from, "rotation", 0);
  slot.scale = vectorOr(from, "scale", Vec2(1));
  if (from.Has("texCoord")) slot.uvSet = from.Get("texCoord").GetNumberAsInt();
}

}  // namespace

GltfTextures::Reference GltfTextures::reference(const tinygltf::Value& extension, const char* key) {
  if (!extension.Has(key)) return {};
  const tinygltf::Value& info = extension.Get(key);
  Reference out;
  if (info.Has("index")) out.index = info.Get("index").GetNumberAsInt();
  if (info.Has("texCoord")) out.uvSet = info.Get("texCoord").GetNumberAsInt();
  if (info.Has("extensions") && info.Get("extensions").Has(kTransform))
    out.transform = &info.Get("extensions").Get(kTransform);
  return out;
}

TextureSlot GltfTextures::make(const Reference& from, const Reading& reading) {
  if (from.index < 0) return {};
  TextureSlot slot;
  slot.uvSet = from.uvSet;
  if (from.transform) transform(*from.transform, slot);
  const std::string who = "textures[" + std::to_string(from.index) + "]";
  if (slot.uvSet < 0 || slot.uvSet > 1) {
    repairs_.add("textures use a UV set above 1 and are left out", who);
    return {};
  }
  const tinygltf::Texture& texture = model_.textures.at(static_cast<std::size_t>(from.index));
  if (texture.source < 0) {
    repairs_.add("textures have no PNG or JPEG image and are left out", who);
    return {};
  }
  const auto [at, isNew] = made_.try_emplace({from.index, reading}, static_cast<int>(scene_.textures.size()));
  if (isNew) scene_.textures.push_back(this->texture(texture, reading));
  slot.texture = at->second;
  return slot;
}

Texture GltfTextures::texture(const tinygltf::Texture& from, const Reading& reading) {
  const EncodedImage& encoded = images_[static_cast<std::size_t>(from.source)];
  auto decoded = decoded_.find(from.source);
  if (decoded == decoded_.end())
    decoded = decoded_.emplace(from.source, decodeImage(encoded.bytes, encoded.name, budget_)).first;
  const auto [srgb, glossiness] = reading;
  Texture out;
  out.name = encoded.name;
  budget_.charge(decoded->second.pixels().size(), sizeof(Rgba8), encoded.name);
  out.image = decoded->second;
  out.srgb = srgb;
  if (glossiness != kNotGlossiness) glossinessToRoughness(out.image, glossiness);
  if (from.sampler < 0) return out;
  const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(from.sampler)];
  out.wrapS = wrapOf(sampler.wrapS);
  out.wrapT = wrapOf(sampler.wrapT);
  out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  return out;
}

}  // namespace saccade::core
