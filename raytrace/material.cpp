#include "raytrace/material.h"

#include <algorithm>
#include <cmath>

#include "core/image_io.h"
#include "core/scene/specular_albedo.h"

namespace saccade::raytrace {
namespace {

/// Byte to linear, for sRGB and for plain data.
struct DecodeTables {
  std::array<float, 256> srgb, plain;
  DecodeTables() {
    for (int i = 0; i < 256; ++i) {
      plain[i] = static_cast<float>(i) / 255.0f;
      srgb[i] = core::decodeSrgb(plain[i]);
    }
  }
};
const DecodeTables& decodeTables() {
  static const DecodeTables tables;
  return tables;
}

/// Texel index of an integer position that may lie outside [0, size).
int wrapTexel(int i, int size, core::Wrap wrap) {
  if (static_cast<unsigned>(i) < static_cast<unsigned>(size)) return i;
  switch (wrap) {
    case core::Wrap::clamp:
      return i < 0 ? 0 : size - 1;
    case core::Wrap::repeat: {
      const int r = i % size;
      return r < 0 ? r + size : r;
    }
    case core::Wrap::mirror: {
      int r = i % (2 * size);
      if (r < 0) r += 2 * size;
      return r < size ? r : 2 * size - 1 - r;
    }
  }
  return 0;
}

}  // namespace

core::Vec4 TextureView::sample(const Vec2& uv) const {
  constexpr float kLargest = 1e6f;  // beyond, a float no longer resolves texels
  const bool sound = std::fabs(uv.x) < kLargest && std::fabs(uv.y) < kLargest;
  const float x = sound ? uv.x * static_cast<float>(width) : 0;
  const float y = sound ? uv.y * static_cast<float>(height) : 0;
  const auto fetch = [&](int row, int column) {
    const core::Rgba8& t = texels[static_cast<std::size_t>(row) * width + column];
    return core::Vec4(decode[t.r], decode[t.g], decode[t.b], static_cast<float>(t.a) * (1 / 255.0f));
  };
  if (nearest) {
    return fetch(wrapTexel(static_cast<int>(std::floor(y)), height, wrapT),
                 wrapTexel(static_cast<int>(std::floor(x)), width, wrapS));
  }
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float fx = x - 0.5f - left, fy = y - 0.5f - top;
  const int x0 = wrapTexel(static_cast<int>(left), width, wrapS);
  const int x1 = wrapTexel(static_cast<int>(left) + 1, width, wrapS);
  const int y0 = wrapTexel(static_cast<int>(top), height, wrapT);
  const int y1 = wrapTexel(static_cast<int>(top) + 1, height, wrapT);
  const core::Vec4 upper = fetch(y0, x0) * (1 - fx) + fetch(y0, x1) * fx;
  const core::Vec4 lower = fetch(y1, x0) * (1 - fx) + fetch(y1, x1) * fx;
  return upper * (1 - fy) + lower * fy;
}

CompiledMaterial compileMaterial(const core::Scene& scene, const core::Material& m) {
  CompiledMaterial c;
  c.baseColor = m.baseColor;
  c.alpha = m.alpha;
  c.emission = m.emission;
  c.metallic = m.metallic;
  c.dielectricF0 = core::dielectricF0(m);
  c.dielectricF90 = core::dielectricF90(c.dielectricF0, m.specular);
  c.specular = m.specular;
  c.roughness = m.roughness;
  c.transmission = m.transmission;
  c.ior = m.ior;
  c.diffuseFactor = core::baseDiffuseFactor(scene, m);
  c.normalScale = m.normalScale;
  c.alphaCutoff = m.alphaCutoff;
  c.alphaMode = m.alphaMode;
  c.doubleSided = m.doubleSided;
  c.unlit = m.unlit;
  const auto view = [&](const core::TextureSlot& slot) {
    TextureView v;
    if (!slot || scene.textures[slot.texture].image.empty()) return v;
    const core::Texture& t = scene.textures[slot.texture];
    v.texels = t.image.pixels().data();
    v.width = t.image.width();
    v.height = t.image.height();
    v.wrapS = t.wrapS;
    v.wrapT = t.wrapT;
    v.nearest = t.nearest;
    v.decode = (t.srgb ? decodeTables().srgb : decodeTables().plain).data();
    v.uvSet = static_cast<std::uint8_t>(slot.uvSet);
    return v;
  };
  c.baseColorTexture = view(m.baseColorTexture);
  c.metallicRoughnessTexture = view(m.metallicRoughnessTexture);
  c.normalTexture = view(m.normalTexture);
  c.emissionTexture = view(m.emissionTexture);
  c.specularTexture = view(m.specularTexture);
  c.specularColorTexture = view(m.specularColorTexture);
  c.transmissionTexture = view(m.transmissionTexture);
  c.textured = c.baseColorTexture || c.metallicRoughnessTexture || c.emissionTexture || c.specularTexture ||
               c.specularColorTexture || c.transmissionTexture;
  return c;
}

}  // namespace saccade::raytrace
