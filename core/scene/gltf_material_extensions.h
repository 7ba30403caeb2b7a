// The extensions of glTF materials, and Ward's lobe through `extras`.
#pragma once

#include <string>

#include "core/scene/gltf_textures.h"
#include "core/scene/repairs.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// What converting an extension takes.
struct MaterialContext {
  GltfTextures& textures;
  Repairs& repairs;
  float unitScale = 1;  ///< metres per unit of the file
};

/// The material's emission in a file of core/scene/export_gltf.h, strength multiplied in; takes the place of
/// emissiveFactor and emissiveTexture.
inline constexpr const char* kOwnEmissionExtension = "SACCADE_emission";

/// Applies KHR_materials_clearcoat, _anisotropy, _dispersion, _emissive_strength, _ior, _iridescence,
/// _pbrSpecularGlossiness, _sheen, _specular, _transmission, _unlit, _volume and SACCADE_emission to a material whose core
/// fields are filled. The gate has checked them.
///
/// _pbrSpecularGlossiness takes the place of pbrMetallicRoughness: metallic 0, baseColor = diffuse, F0 =
/// specular (exactly: an index of refraction whose reflectance is 1, tinted by specularColor), roughness = 1
/// - glossiness. Departure: the diffuse part is not scaled by 1 - max(specular), which was that extension's
/// way of conserving energy; the layering of core/scene/specular_albedo.h is ours.
void applyMaterialExtensions(const tinygltf::ExtensionMap& extensions, MaterialContext& context, Material& m);

/// {"saccade": {"ward": {"diffuse": [r, g, b], "specular": [r, g, b], "alpha": [x, y]}}}: the material
/// becomes Ward's; of what it was, name, coverage, emission, sides, normal map and the base colour's texture
/// (which multiplies `diffuse`) stay. baseColor = diffuse, metallic = transmission = specular = 0. Albedos
/// are clamped to [0, 1] and alphas to [0.001, 1], counted; diffuse + specular above 1 in a channel scales
/// both down, counted. Throws core::Error "WHO: RULE" for members that are missing or of another type.
void applyWardExtras(const tinygltf::Value& extras, const std::string& who, MaterialContext& context,
                     Material& m);

}  // namespace saccade::core
