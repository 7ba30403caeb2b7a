// Directional and mean albedo of the single-scatter GGX lobe with Schlick's Fresnel (height-correlated
// Smith):
//   E(cosV) = F0 * a + F90 * b, tabulated once by fixed quadrature (deterministic).
// F90 is 1 for metals and dielectricF90 for dielectrics.
// The Lambert lobe under a specular lobe is layered so that energy is conserved and reciprocal (Kelemen,
// Szirmay-Kalos 2001):
//   f_d = c/pi * (1 - E(v)) (1 - E(l)) / (1 - Emean)
// whose view-independent part under an irradiance map is c/pi * (1 - Emean): the base layer's diffuse factor.
// The correction adds the rest. Under
// sheen and a clearcoat, 1 - E is the product of all that passes (OverLambert), its mean is taken by
// quadrature. Departure from glTF's appendix B, (1 - F(v.h)): that form exceeds 1 at grazing angles.
#pragma once

#include <algorithm>

#include "core/scene/scene.h"

namespace saccade::core {

struct AlbedoPair {
  float scale = 0;  ///< a: multiplies F0
  float bias = 0;   ///< b: multiplies F90
};
/// E = F0 a + F90 b by channel, at most 1.
inline Vec3 lobeAlbedo(const AlbedoPair& pair, const Vec3& f0, float f90) {
  return glm::min(f0 * pair.scale + Vec3(f90 * pair.bias), Vec3(1));
}

/// cosView and roughness (perceptual) in [0, 1], clamped. Thread safe.
AlbedoPair directionalAlbedo(float cosView, float roughness);
AlbedoPair meanAlbedo(float roughness);  ///< cosine-weighted mean over the hemisphere: 2 * integral E(c) c dc

/// Reflectance at normal incidence of a dielectric: ((ior - 1) / (ior + 1))^2 * specularColor * specular,
/// clamped to 1.
Vec3 dielectricF0(const Material& material);

/// Reflectance of the dielectric lobe at grazing incidence, for an F0 that specular is already part of:
/// min(specular, 50 * largest component of F0). KHR_materials_specular has F90 = specular. Departure: an F0
/// below 2 % fades the lobe out (Lagarde 2014), so that specularColor = 0 and ior = 1 mean no lobe at all, as
/// in the programs that write such files.
float dielectricF90(const Vec3& f0, float specular);

/// KHR_materials_clearcoat's index is 1.5.
inline constexpr float kCoatF0 = 0.04f;

/// What lies over a Lambert lobe: its own dielectric surface, sheen over that, a coat over both.
struct OverLambert {
  Vec3 f0{0};
  float f90 = 1;
  float roughness = 1;
  float sheen = 0;  ///< largest channel of the sheen's colour
  float sheenRoughness = 0;
  float coat = 0;
  float coatRoughness = 0;
};
/// The roughness whose isotropic albedo an anisotropic lobe (KHR_materials_anisotropy) stays below: seen
/// across the brushing it reflects up to 0.01 more than its narrow alpha alone would.
inline float roughnessOverLambert(float roughness, float anisotropy) {
  return std::max(0.0f, roughness - 0.03f * anisotropy);
}
/// What passes a coat at that cosine: 1 - coat E(cosine).
float coatTransmission(float coat, float coatRoughness, float cosine);
/// What passes sheen: 1 - max(colour) E(cosine), KHR_materials_sheen.
float sheenTransmission(float sheen, float sheenRoughness, float cosine);
/// What passes all of it; coatCosine is against the coat's own normal.
Vec3 transmission(const OverLambert& over, float cosine, float coatCosine);
/// Cosine-weighted mean over the hemisphere of transmission(): 1 - Emean where only the dielectric is there.
Vec3 meanTransmission(const OverLambert& over);

/// The view-independent diffuse factor of a material apart from baseColor, (1 - metallic) and (1 -
/// transmission), which may be textured: 1 - luminance-mean specular albedo of its dielectric lobe (roughness
/// averaged over its texture); with sheen or a coat, the luminance of meanTransmission; 1 under Ward's lobe,
/// whose file says how much is left. Objects treated as diffuse and non-diffuse ones use the same factor.
/// Base radiance of a lit pixel:
///   emission + baseColor * (1 - metallic) * (1 - transmission) * baseDiffuseFactor / pi * irradiance
/// times coverage for alphaMode blend. Unlit materials: baseColor.
float baseDiffuseFactor(const Scene& scene, const Material& material);

}  // namespace saccade::core
