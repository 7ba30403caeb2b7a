// What a surface needs from its fragment program: one specialised program per set of features that occurs,
// nothing for what does not.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/scene/scene.h"

namespace saccade::render {

enum Feature : std::uint32_t {
  kLightmap = 1u << 0,             ///< irradiance from the maps
  kBackLayer = 1u << 1,            ///< the maps' layer 1 on the back side
  kBaseTexture = 1u << 2,          ///< colour and coverage
  kVertexColor = 1u << 3,          ///< likewise
  kMetallicTexture = 1u << 4,      ///< B
  kTransmissionTexture = 1u << 5,  ///< R
  kEmissionTexture = 1u << 6,
  kEmission = 1u << 7,
  kFrontEmission = 1u << 8,  ///< only on the front side
  kAlphaMask = 1u << 9,
  kBlend = 1u << 10,
  // Which UV set a texture reads.
  kBaseUv1 = 1u << 11,
  kMetallicUv1 = 1u << 12,
  kTransmissionUv1 = 1u << 13,
  kEmissionUv1 = 1u << 14,
  // KHR_texture_transform moves its uv.
  kBaseTransform = 1u << 15,
  kMetallicTransform = 1u << 16,
  kTransmissionTransform = 1u << 17,
  kEmissionTransform = 1u << 18,
  kMapDetail = 1u << 19,   ///< texels of the maps may have blocks of finer ones
  kVertexLight = 1u << 20  ///< irradiance is read by vertex (core::Mesh::vertexLit)
};
using Features = std::uint32_t;

/// Vertex attributes, also their locations.
enum VertexAttribute : std::uint32_t { kPosition = 0, kLightmapUv = 1, kUv0 = 2, kUv1 = 3, kColor = 4 };

/// Texture units.
enum TextureUnit : int {
  kMapsUnit,
  kMapBlocksUnit,
  kBaseUnit,
  kMetallicUnit,
  kTransmissionUnit,
  kEmissionUnit,
  kUnitCount
};

/// How the base layer reads one of a material's textures.
struct TextureUse {
  TextureUnit unit;
  core::TextureSlot core::Material::*slot;
  Feature texture, secondUv, transform;
  const char* macro;    ///< MACRO_TEXTURE: it is there; MACRO_UV: where it is read
  const char* sampler;  ///< uniforms
  const char* uvMatrix;
};
inline constexpr std::array kTextureUses{
    TextureUse{kBaseUnit, &core::Material::baseColorTexture, kBaseTexture, kBaseUv1, kBaseTransform, "BASE",
               "baseTexture", "baseUvMatrix"},
    TextureUse{kMetallicUnit, &core::Material::metallicRoughnessTexture, kMetallicTexture, kMetallicUv1,
               kMetallicTransform, "METALLIC", "metallicTexture", "metallicUvMatrix"},
    TextureUse{kTransmissionUnit, &core::Material::transmissionTexture, kTransmissionTexture,
               kTransmissionUv1, kTransmissionTransform, "TRANSMISSION", "transmissionTexture",
               "transmissionUvMatrix"},
    TextureUse{kEmissionUnit, &core::Material::emissionTexture, kEmissionTexture, kEmissionUv1,
               kEmissionTransform, "EMISSION", "emissionTexture", "emissionUvMatrix"}};

/// The uniform `surface` of the fragment program, vec4[3].
struct SurfaceConstants {
  core::Vec3 diffuse{0};  ///< radiance per irradiance / pi, untextured; what unlit materials show
  float id = 0;
  core::Vec3 emission{0};
  float coverage = 1;
  float metallic = 0;      ///< multiplies its texture
  float transmission = 0;  ///< multiplies its texture
  float cutoff = 0;
  float padding = 0;
};
static_assert(sizeof(SurfaceConstants) == 12 * sizeof(float));

/// How an object of the scene is drawn when illumination maps are there.
Features featuresOf(const core::Scene& scene, const core::Object& object);
SurfaceConstants constantsOf(const core::Scene& scene, const core::Object& object);

/// The same without maps: constant irradiance pi.
inline Features withoutMaps(Features f) { return f & ~(kLightmap | kBackLayer | kVertexLight); }
/// The same with maps of one layer.
inline Features withoutBackLayer(Features f) { return f & ~kBackLayer; }
/// The same with maps that have detail.
inline Features withMapDetail(Features f) { return f & kLightmap ? f | kMapDetail : f; }

/// The attributes (bits 1 << VertexAttribute) that a program with these features reads.
std::uint32_t attributesOf(Features features);

std::string vertexShader(Features features);
std::string fragmentShader(Features features);

}  // namespace saccade::render
