// Means of a material's textures times its factors, in linear space.
#pragma once

#include "core/scene/scene.h"
#include "core/scene/specular_albedo.h"

namespace saccade::core {

/// Mean of a texture's texels, channels decoded to linear (alpha as it is). Large images are read on a
/// regular grid of at least 512 x 512 texels.
Vec4 textureMean(const Texture& texture);

/// What plan and base layer need to know about a material as a whole: means over its textures, products of
/// means for products.
struct MaterialMeans {
  Vec3 baseColor{1};
  float alpha = 1;
  float metallic = 0;
  float roughness = 1;
  float transmission = 0;
  Vec3 dielectricAlbedo{0};  ///< mean albedo of the dielectric specular lobe
  Vec3 metallicAlbedo{0};    ///< mean albedo of the lobe with F0 = baseColor
  OverLambert over;          ///< the dielectric lobe, sheen and coat
  Vec3 sheenColor{0};
};
MaterialMeans materialMeans(const Scene& scene, const Material& material);

}  // namespace saccade::core
