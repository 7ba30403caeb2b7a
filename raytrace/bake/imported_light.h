// Light that another program baked into images over a mesh's second UV set, brought into our atlas.
#pragma once

#include <span>
#include <vector>

#include "core/image.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

/// Irradiance without albedo in W/m^2, finite and >= 0; row 0 is at v = 0 (glTF: v runs downwards).
struct ImportedLight {
  std::vector<core::ImageRgb> images;
  std::vector<int> imageOfObject;  ///< by object of the scene; -1: our own bake stands
};

/// An object can show imported light: every vertex of its mesh has a finite place in the second UV set.
bool hasLightmapUv(const core::Mesh& mesh);

/// Replaces the texels of objects that have an image by the image's mean over the texel's surface, found
/// through uv1, bilinearly. Coordinates outside [0, 1] repeat the image, those inside never reach across its
/// edge; where parts of a mesh lie over each other in uv1 they show the same light, as in the program that
/// made the image. The front and the back of double-sided surfaces get the same. `charted` is the scene of
/// `texels`. Objects that have an image must pass hasLightmapUv. The result does not depend on `threads`.
/// Throws core::Error when stopped.
void importIrradiance(const TexelMap& texels, const core::Scene& charted, const ImportedLight& imported,
                      int threads, std::span<core::Vec3> irradiance);

}  // namespace saccade::raytrace
