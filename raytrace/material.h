// Materials as the tracer wants them: factors and resolved textures, packed once per scene.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"
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

  /// Seen from behind: a closed or thin transmitter and double-sided surfaces scatter, others are black.
  bool scattersBehind() const { return doubleSided || transmission > 0; }
  bool emits() const { return !unlit && (emission.x > 0 || emission.y > 0 || emission.z > 0); }
};

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
};

}  // namespace saccade::raytrace
