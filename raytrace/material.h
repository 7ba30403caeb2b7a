// Materials as the tracer wants them: factors and resolved textures, packed once per scene.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/scene/scene.h"
#include "raytrace/extension.h"
#include "raytrace/ray.h"
#include "raytrace/texture_store.h"

namespace saccade::raytrace {

/// One material, compiled. All functions of it may be called from any thread.
struct CompiledMaterial {
  Vec3 baseColor{1};
  float alpha = 1;
  Vec3 emission{0};
  float metallic = 0;
  Vec3 dielectricF0{0.04f};
  float roughness = 1;
  float dielectricF90 = 1;
  float specular = 1;
  float transmission = 0;
  float ior = 1.5f;
  float diffuseFactor = 1;  ///< core::baseDiffuseFactor
  float normalScale = 1;
  float alphaCutoff = 0.5f;
  core::AlphaMode alphaMode = core::AlphaMode::opaque;
  bool doubleSided = false;
  bool unlit = false;
  bool textured = false;  ///< some texture other than the normal map: parameters vary over the surface
  TextureView baseColorTexture, metallicRoughnessTexture, normalTexture, emissionTexture, specularTexture,
      specularColorTexture, transmissionTexture;
  std::shared_ptr<const CompiledExtension> extension;  ///< null: none
  /// KHR_materials_volume: extinction inside a solid, per metre; see absorption().
  Vec3 absorption{0};
  float dispersion = 0;  ///< KHR_materials_dispersion; 0 where nothing is split

  /// Seen from behind: a closed or thin transmitter and double-sided surfaces scatter, others are black.
  bool scattersBehind() const { return doubleSided || transmission > 0; }
  bool emits() const { return !unlit && (emission.x > 0 || emission.y > 0 || emission.z > 0); }
};

/// -ln(attenuationColor) / attenuationDistance by channel: 0 without attenuation, infinite for a channel of
/// 0.
Vec3 absorption(const core::Material& material);
/// exp(-absorption * distance) by channel; 1 where either is 0, whatever the other. distance >= 0 or
/// infinite.
Vec3 beerLambert(const Vec3& absorption, float distance);

/// KHR_materials_dispersion: the index that channel 0, 1 or 2 sees, >= 1.
inline float dispersedIor(float ior, float dispersion, int channel) {
  return std::max(1.0f, ior + static_cast<float>(channel - 1) * (ior - 1) * 0.025f * dispersion);
}
/// What stands for all channels where one in three is followed.
inline Vec3 heroOf(const Vec3& color, int channel) {
  Vec3 hero(0);
  hero[channel] = 3 * color[channel];
  return hero;
}

CompiledMaterial compileMaterial(const core::Scene& scene, const core::Material& material,
                                 const TextureStore& textures);

/// Material parameters at one point.
struct MaterialPoint {
  Vec3 baseColor{1};   ///< linear, [0, 1]
  float coverage = 1;  ///< alphaMode blend: [0, 1]; else 1
  Vec3 emission{0};    ///< radiance towards the front (both sides when double-sided)
  float metallic = 0;
  Vec3 dielectricF0{0.04f};
  float dielectricF90 = 1;
  float roughness = 1;  ///< perceptual, [0, 1]
  float transmission = 0;
  float ior = 1.5f;
  float diffuseFactor = 1;
  std::optional<ExtensionPoint> extension;  ///< filled by makeSurface
};

}  // namespace saccade::raytrace
