// A charted scene with its illumination as glTF that viewers without lightmaps show lit
// (docs/lightmaps.md).
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// What the code 255 of a material's texels stands for; 0: the material has no texels.
struct MaterialLight {
  float radiance = 0;    ///< of LightTextures::emission, W/m^2/sr
  float irradiance = 0;  ///< of LightTextures::lightmap: irradiance / pi, what multiplies the albedo
};

/// Illumination maps as sRGB pictures over the atlas, row 0 at v = 0. Every material has a range of its own.
struct LightTextures {
  ImageRgba8 emission;  ///< radiance that leaves: reflected diffusely, and the material's own
  ImageRgba8 lightmap;
  std::vector<MaterialLight> materials;  ///< by material of the scene
};

/// The bytes of a GLB: the nodes that hold objects (names, tree and transforms as loaded), geometry with
/// TEXCOORD_0 as loaded and TEXCOORD_1 = place in the atlas, all materials by index with their textures
/// (PNG), the cameras; no lights. TEXCOORD_0 repeats the atlas where the scene has none, because glTF wants
/// the sets numbered without gaps. Objects of an instanced mesh share all accessors but TEXCOORD_1. A
/// material that `light` gives texels shows its light through emissiveTexture and as MOZ_lightmap; its own
/// emission stands in SACCADE_emission, by which loadScene gets it back. Deterministic. Throws core::Error
/// when the file would exceed 4 GiB.
std::vector<std::uint8_t> exportGltf(const Scene& charted, const LightTextures& light);

}  // namespace saccade::core
