// Directional and mean albedo of the single-scatter GGX lobe with Schlick's Fresnel, F90 = 1
// (height-correlated Smith):
//   E(cosV) = F0 * a + b, tabulated once by fixed quadrature (deterministic).
// The Lambert lobe under a specular lobe is layered so that energy is conserved and reciprocal (Kelemen,
// Szirmay-Kalos 2001):
//   f_d = c/pi * (1 - E(v)) (1 - E(l)) / (1 - Emean)
// whose view-independent part under an irradiance map is c/pi * (1 - Emean): the base layer's diffuse factor.
// The correction adds the rest. Departure from glTF's appendix B, (1 - F(v.h)): that form exceeds 1 at
// grazing angles.
#pragma once

#include "core/scene/scene.h"

namespace saccade::core {

struct AlbedoPair {
  float scale = 0;  ///< a: multiplies F0
  float bias = 0;   ///< b
};

/// cosView and roughness (perceptual) in [0, 1], clamped. Thread safe.
AlbedoPair directionalAlbedo(float cosView, float roughness);
AlbedoPair meanAlbedo(float roughness);  ///< cosine-weighted mean over the hemisphere: 2 * integral E(c) c dc

/// Reflectance at normal incidence of a dielectric: ((ior - 1) / (ior + 1))^2 * specularColor * specular,
/// clamped to 1.
Vec3 dielectricF0(const Material& material);

/// The view-independent diffuse factor of a material apart from baseColor, (1 - metallic) and (1 -
/// transmission), which may be textured: 1 - luminance-mean specular albedo of its dielectric lobe (roughness
/// averaged over its texture). Objects treated as diffuse and non-diffuse ones use the same factor. Base
/// radiance of a lit pixel:
///   emission + baseColor * (1 - metallic) * (1 - transmission) * baseDiffuseFactor / pi * irradiance
/// times coverage for alphaMode blend. Unlit materials: baseColor.
float baseDiffuseFactor(const Scene& scene, const Material& material);

}  // namespace saccade::core
