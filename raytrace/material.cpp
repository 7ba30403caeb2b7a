#include "raytrace/material.h"

#include <algorithm>
#include <cmath>

#include "core/scene/specular_albedo.h"

namespace saccade::raytrace {

Vec3 absorption(const core::Material& m) {
  Vec3 sigma(0);
  if (!m.attenuates()) return sigma;
  for (int c = 0; c < 3; ++c) {
    const float left = std::clamp(m.attenuationColor[c], 0.0f, 1.0f);
    sigma[c] = left < 1 ? -std::log(left) / m.attenuationDistance : 0;
  }
  return sigma;
}

Vec3 beerLambert(const Vec3& absorption, float distance) {
  Vec3 left(1);
  for (int c = 0; c < 3; ++c) {
    if (absorption[c] > 0 && distance > 0) left[c] = std::exp(-absorption[c] * distance);
  }
  return left;
}

CompiledMaterial compileMaterial(const core::Scene& scene, const core::Material& m,
                                 const TextureStore& textures) {
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
  c.baseColorTexture = textures.view(m.baseColorTexture);
  c.metallicRoughnessTexture = textures.view(m.metallicRoughnessTexture);
  c.normalTexture = textures.view(m.normalTexture);
  c.emissionTexture = textures.view(m.emissionTexture);
  c.specularTexture = textures.view(m.specularTexture);
  c.specularColorTexture = textures.view(m.specularColorTexture);
  c.transmissionTexture = textures.view(m.transmissionTexture);
  c.extension = compileExtension(m, textures);
  c.absorption = absorption(m);
  c.dispersion = m.disperses() ? m.dispersion : 0;
  c.textured = c.baseColorTexture || c.metallicRoughnessTexture || c.emissionTexture || c.specularTexture ||
               c.specularColorTexture || c.transmissionTexture;
  return c;
}

}  // namespace saccade::raytrace
