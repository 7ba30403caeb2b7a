// The extensions' objects, property by property, as their Khronos texts give them.
#include <array>

#include "core/scene/gltf_rule_makers.h"

namespace saccade::core {
namespace {

using namespace rules;

// ---- materials

/// 0 is the extension's switch for "reflects everything".
constexpr std::array kIor = {number("ior").atLeast(1).orZero().mend(kMaterialFactors)};
constexpr std::array kEmissiveStrength = {number("emissiveStrength").atLeast(0).mend(kMaterialFactors)};
constexpr std::array kTransmission = {factor("transmissionFactor"), texture("transmissionTexture")};
constexpr std::array kSpecular = {factor("specularFactor"), texture("specularTexture"),
                                  numbers("specularColorFactor", 3).atLeast(0).mend(kMaterialFactors),
                                  texture("specularColorTexture")};
constexpr std::array kVolume = {
    number("thicknessFactor").atLeast(0).mend(kMaterialFactors), texture("thicknessTexture"),
    number("attenuationDistance").above(0).mend(kMaterialFactors), color("attenuationColor")};
constexpr std::array kClearcoat = {factor("clearcoatFactor"), texture("clearcoatTexture"),
                                   factor("clearcoatRoughnessFactor"), texture("clearcoatRoughnessTexture"),
                                   object("clearcoatNormalTexture", kNormalTextureInfo)};
constexpr std::array kAnisotropy = {factor("anisotropyStrength"),
                                    number("anisotropyRotation").mend(kMaterialFactors),
                                    texture("anisotropyTexture")};
constexpr std::array kSheen = {color("sheenColorFactor"), texture("sheenColorTexture"),
                               factor("sheenRoughnessFactor"), texture("sheenRoughnessTexture")};
constexpr std::array kIridescence = {factor("iridescenceFactor"),
                                     texture("iridescenceTexture"),
                                     number("iridescenceIor").atLeast(1).mend(kMaterialFactors),
                                     number("iridescenceThicknessMinimum").atLeast(0).mend(kMaterialFactors),
                                     number("iridescenceThicknessMaximum").atLeast(0).mend(kMaterialFactors),
                                     texture("iridescenceThicknessTexture")};
constexpr std::array kDispersion = {number("dispersion").atLeast(0).mend(kMaterialFactors)};
constexpr std::array kSpecularGlossiness = {numbers("diffuseFactor", 4).in(0, 1).mend(kMaterialFactors),
                                            texture("diffuseTexture"), color("specularFactor"),
                                            factor("glossinessFactor"), texture("specularGlossinessTexture")};

/// What export_gltf.h writes. The first is not read: the maps have all of it.
constexpr std::array kLightmap = {index("index", "textures").must(), kTexCoord,
                                  number("intensity").atLeast(0).mend(kMaterialFactors)};
constexpr std::array kOwnEmission = {numbers("emissiveFactor", 3).atLeast(0).mend(kMaterialFactors),
                                     texture("emissiveTexture")};

constexpr ExtensionRule kAtMaterial[] = {{"KHR_materials_anisotropy", {kAnisotropy}},
                                         {"KHR_materials_clearcoat", {kClearcoat}},
                                         {"KHR_materials_dispersion", {kDispersion}},
                                         {"KHR_materials_emissive_strength", {kEmissiveStrength}},
                                         {"KHR_materials_ior", {kIor}},
                                         {"KHR_materials_iridescence", {kIridescence}},
                                         {"KHR_materials_pbrSpecularGlossiness", {kSpecularGlossiness}},
                                         {"KHR_materials_sheen", {kSheen}},
                                         {"KHR_materials_specular", {kSpecular}},
                                         {"KHR_materials_transmission", {kTransmission}},
                                         {"KHR_materials_unlit", {}},
                                         {"KHR_materials_volume", {kVolume}},
                                         {"MOZ_lightmap", {kLightmap}},
                                         {"SACCADE_emission", {kOwnEmission}}};

// ---- textures

constexpr std::array kTransform = {numbers("offset", 2), number("rotation"), numbers("scale", 2), kTexCoord};
constexpr ExtensionRule kAtTextureInfo[] = {{"KHR_texture_transform", {kTransform}}};
constexpr std::array kOtherSource = {index("source", "images")};
constexpr ExtensionRule kAtTexture[] = {{"EXT_texture_webp", {kOtherSource}},
                                        {"KHR_texture_basisu", {kOtherSource}}};

// ---- lights

constexpr const char* kLightValues = "light values out of range were clamped";
constexpr double kRightAngle = 1.5707963267948966;
constexpr std::array kSpotProperties = {number("innerConeAngle").in(0, kRightAngle).mend(kLightValues),
                                        number("outerConeAngle").in(0, kRightAngle).mend(kLightValues)};
constexpr ObjectRule kSpot{kSpotProperties};
constexpr std::array kLightProperties = {numbers("color", 3).in(0, 1).mend(kLightValues),
                                         number("intensity").atLeast(0).mend(kLightValues),
                                         number("range").above(0).mend(kLightValues),
                                         text("type").must(),
                                         object("spot", kSpot),
                                         text("name")};
constexpr ObjectRule kLight{kLightProperties};
constexpr std::array kLights = {objects("lights", kLight).must()};
/// Range: below the number of lights, which checkReferences knows.
constexpr std::array kNodeLight = {integer("light").in(0, kLargestIndex).must()};
constexpr ExtensionRule kAtNode[] = {{"KHR_lights_punctual", {kNodeLight}}};

// ---- known so that they are found in their place, though what they add is left out

constexpr std::array kVariantProperties = {text("name").must()};
constexpr ObjectRule kVariant{kVariantProperties};
constexpr std::array kVariants = {objects("variants", kVariant).must()};
constexpr std::array kMappingProperties = {index("material", "materials").must(), text("name")};
constexpr ObjectRule kMapping{kMappingProperties};
constexpr std::array kMappings = {objects("mappings", kMapping).must()};
constexpr std::array kPointer = {text("pointer").must()};

constexpr ExtensionRule kAtRoot[] = {{"KHR_lights_punctual", {kLights}},
                                     {"KHR_materials_variants", {kVariants}}};
constexpr ExtensionRule kAtPrimitive[] = {{"KHR_materials_variants", {kMappings}}};
constexpr ExtensionRule kAtTarget[] = {{"KHR_animation_pointer", {kPointer}}};

}  // namespace

std::span<const ExtensionRule> extensionsAt(Place place) {
  switch (place) {
    case Place::root:
      return kAtRoot;
    case Place::node:
      return kAtNode;
    case Place::material:
      return kAtMaterial;
    case Place::texture:
      return kAtTexture;
    case Place::textureInfo:
      return kAtTextureInfo;
    case Place::primitive:
      return kAtPrimitive;
    case Place::channelTarget:
      return kAtTarget;
    case Place::none:
      break;
  }
  return {};
}

}  // namespace saccade::core
