#include "render/base/features.h"

#include <array>

#include "core/scene/specular_albedo.h"

namespace saccade::render {

namespace {

bool isBlack(const core::Vec3& c) { return c == core::Vec3(0); }

/// A slot that names a UV set the mesh lacks reads the first, as the tracer does.
void addTexture(Features& features, const core::Mesh& mesh, const core::Material& m, TextureUnit unit) {
  const TextureUse& use = kTextureUses[static_cast<std::size_t>(unit - kBaseUnit)];
  const core::TextureSlot& slot = m.*use.slot;
  if (!slot) return;
  features |= use.texture;
  if (slot.uvSet == 1 && !mesh.uv1.empty()) features |= use.secondUv;
  if (slot.transformed()) features |= use.transform;
}

/// Radiance per irradiance / pi, before textures.
core::Vec3 diffuseScale(const core::Scene& scene, const core::Material& m) {
  if (m.unlit) return m.baseColor;
  core::Vec3 scale = m.baseColor * core::baseDiffuseFactor(scene, m);
  if (!m.metallicRoughnessTexture) scale *= 1 - m.metallic;
  if (!m.transmissionTexture) scale *= 1 - m.transmission;
  return scale;
}

struct NamedFeature {
  Feature feature;
  const char* macro;
};
constexpr std::array kMacros{NamedFeature{kLightmap, "LIGHTMAP"},
                             NamedFeature{kBackLayer, "BACK_LAYER"},
                             NamedFeature{kMapDetail, "MAP_DETAIL"},
                             NamedFeature{kVertexLight, "VERTEX_LIGHT"},
                             NamedFeature{kVertexColor, "VERTEX_COLOR"},
                             NamedFeature{kEmission, "EMISSION"},
                             NamedFeature{kFrontEmission, "FRONT_EMISSION"},
                             NamedFeature{kAlphaMask, "ALPHA_MASK"},
                             NamedFeature{kBlend, "BLEND"}};

std::string header(Features features) {
  std::string text = "#version 330 core\n";
  for (const NamedFeature& f : kMacros) {
    if (features & f.feature) text += std::string("#define ") + f.macro + "\n";
  }
  const std::uint32_t attributes = attributesOf(features);
  if (attributes & (1u << kUv0)) text += "#define UV0\n";
  if (attributes & (1u << kUv1)) text += "#define UV1\n";
  for (const TextureUse& use : kTextureUses) {
    if (!(features & use.texture)) continue;
    const char* uv = features & use.secondUv ? "uv1" : "uv0";
    const auto append = [&](auto... parts) { (text.append(parts), ...); };
    append("#define ", use.macro, "_TEXTURE\n#define ", use.macro, "_UV ");
    if (features & use.transform) {
      append("(", use.uvMatrix, " * vec3(", uv, ", 1.0))\n");
    } else {
      append(uv, "\n");
    }
  }
  return text;
}

constexpr const char* kVertexBody = R"(
layout(location = 0) in vec3 positionIn;
invariant gl_Position;  // the same depth whatever the features
uniform mat4 meshToClip;
#ifdef LIGHTMAP
layout(location = 1) in vec2 lightmapUvIn;
uniform vec4 lightmapPlace;  // core::placeInAtlas
#ifdef VERTEX_LIGHT
uniform sampler2DArray maps;
#ifdef MAP_DETAIL
uniform usampler2D mapBlocks;
#endif
out vec3 frontIrradiance;
#ifdef BACK_LAYER
out vec3 backIrradiance;
#endif
#else
out vec2 lightmapUv;
#endif
#endif
#ifdef UV0
layout(location = 2) in vec2 uv0In;
out vec2 uv0;
#endif
#ifdef UV1
layout(location = 3) in vec2 uv1In;
out vec2 uv1;
#endif
#ifdef VERTEX_COLOR
layout(location = 4) in vec4 colorIn;
out vec4 color;
#endif
void main() {
  gl_Position = meshToClip * vec4(positionIn, 1.0);
#ifdef LIGHTMAP
  vec2 place = lightmapUvIn * lightmapPlace.xy + lightmapPlace.zw;
#ifdef VERTEX_LIGHT
#ifdef MAP_DETAIL
  ivec2 texel = ivec2(place * vec2(textureSize(mapBlocks, 0)));  // of the atlas, the upper rows of `maps`
#else
  ivec2 texel = ivec2(place * vec2(textureSize(maps, 0).xy));
#endif
  frontIrradiance = texelFetch(maps, ivec3(texel, 0), 0).rgb;
#ifdef BACK_LAYER
  backIrradiance = texelFetch(maps, ivec3(texel, 1), 0).rgb;
#endif
#else
  lightmapUv = place;
#endif
#endif
#ifdef UV0
  uv0 = uv0In;
#endif
#ifdef UV1
  uv1 = uv1In;
#endif
#ifdef VERTEX_COLOR
  color = colorIn;
#endif
}
)";

constexpr const char* kFragmentBody = R"(
out vec4 radianceAndId;
uniform vec4 surface[3];  // SurfaceConstants
#ifdef VERTEX_LIGHT
in vec3 frontIrradiance;
#ifdef BACK_LAYER
in vec3 backIrradiance;
#endif
#elif defined(LIGHTMAP)
in vec2 lightmapUv;
uniform sampler2DArray maps;
#endif
#if defined(MAP_DETAIL) && !defined(VERTEX_LIGHT)
uniform usampler2D mapBlocks;
// core/map_detail.h, in coordinates of the texture that holds atlas and detail (MapTextures).
vec2 mapPlace() {
  vec2 atlas = vec2(textureSize(mapBlocks, 0));
  vec2 place = clamp(lightmapUv, 0.0, 1.0) * atlas;
  vec2 texel = min(floor(place), atlas - 1.0);
  uint block = texelFetch(mapBlocks, ivec2(texel), 0).r;
  if (block != 0u) {
    vec2 corner = vec2(block & 0x1FFFu, block >> 13 & 0x1FFFu);
    vec2 cells = vec2(1u << (block >> 26 & 7u), 1u << (block >> 29));
    place = vec2(0.0, atlas.y + 1.0) + corner + (place - texel) * cells;
  }
  return place / vec2(textureSize(maps, 0).xy);
}
#endif
#ifdef UV0
in vec2 uv0;
#endif
#ifdef UV1
in vec2 uv1;
#endif
#ifdef VERTEX_COLOR
in vec4 color;
#endif
void main() {
  vec3 radiance = surface[0].rgb;
  float coverage = surface[1].a;
#ifdef BASE_TEXTURE
  vec4 base = texture(baseTexture, BASE_UV);
  radiance *= base.rgb;
  coverage *= base.a;
#endif
#ifdef VERTEX_COLOR
  radiance *= color.rgb;
  coverage *= color.a;
#endif
#ifdef ALPHA_MASK
  if (coverage < surface[2].z) discard;
#endif
#ifdef METALLIC_TEXTURE
  radiance *= 1.0 - surface[2].x * texture(metallicTexture, METALLIC_UV).b;
#endif
#ifdef TRANSMISSION_TEXTURE
  radiance *= 1.0 - surface[2].y * texture(transmissionTexture, TRANSMISSION_UV).r;
#endif
#ifdef VERTEX_LIGHT
#ifdef BACK_LAYER
  radiance *= gl_FrontFacing ? frontIrradiance : backIrradiance;
#else
  radiance *= frontIrradiance;
#endif
#elif defined(LIGHTMAP)
#ifdef BACK_LAYER
  float layer = gl_FrontFacing ? 0.0 : 1.0;
#else
  const float layer = 0.0;
#endif
#ifdef MAP_DETAIL
  radiance *= textureLod(maps, vec3(mapPlace(), layer), 0.0).rgb;
#else
  radiance *= texture(maps, vec3(lightmapUv, layer)).rgb;
#endif
#endif
#ifdef EMISSION
  vec3 emission = surface[1].rgb;
#ifdef EMISSION_TEXTURE
  emission *= texture(emissionTexture, EMISSION_UV).rgb;
#endif
#ifdef FRONT_EMISSION
  if (gl_FrontFacing) radiance += emission;
#else
  radiance += emission;
#endif
#endif
#ifdef BLEND
  radiance *= clamp(coverage, 0.0, 1.0);
#endif
  radianceAndId = vec4(radiance, surface[0].a);
}
)";

}  // namespace

Features featuresOf(const core::Scene& scene, const core::Object& object) {
  const core::Material& m = scene.materials[object.material];
  const core::Mesh& mesh = scene.meshOf(object);
  Features f = 0;
  const bool diffuse = !isBlack(diffuseScale(scene, m));
  if (m.alphaMode == core::AlphaMode::mask) f |= kAlphaMask;
  if (m.alphaMode == core::AlphaMode::blend) f |= kBlend;
  if (diffuse || f != 0) {
    addTexture(f, mesh, m, kBaseUnit);
    if (!mesh.colors.empty()) f |= kVertexColor;
  }
  if (diffuse && !m.unlit) {
    if (!mesh.lightmapUv.empty()) f |= m.doubleSided ? kLightmap | kBackLayer : kLightmap;
    if (mesh.vertexLit) f |= kVertexLight;
    if (m.metallic != 0) addTexture(f, mesh, m, kMetallicUnit);
    if (m.transmission != 0) addTexture(f, mesh, m, kTransmissionUnit);
  }
  if (m.emits()) {
    f |= m.doubleSided ? kEmission : kEmission | kFrontEmission;
    addTexture(f, mesh, m, kEmissionUnit);
  }
  return f;
}

SurfaceConstants constantsOf(const core::Scene& scene, const core::Object& object) {
  const core::Material& m = scene.materials[object.material];
  SurfaceConstants c;
  c.diffuse = diffuseScale(scene, m);
  c.id = static_cast<float>(object.id);
  c.emission = m.emission;
  c.coverage = m.alpha;
  c.metallic = m.metallic;
  c.transmission = m.transmission;
  c.cutoff = m.alphaCutoff;
  return c;
}

std::uint32_t attributesOf(Features features) {
  std::uint32_t attributes = 1u << kPosition;
  if (features & kLightmap) attributes |= 1u << kLightmapUv;
  if (features & kVertexColor) attributes |= 1u << kColor;
  for (const TextureUse& use : kTextureUses)
    if (features & use.texture) attributes |= features & use.secondUv ? 1u << kUv1 : 1u << kUv0;
  return attributes;
}

std::string vertexShader(Features features) { return header(features) + kVertexBody; }

std::string fragmentShader(Features features) {
  std::string uniforms;
  for (const TextureUse& use : kTextureUses) {
    if (features & use.texture) uniforms += "uniform sampler2D " + std::string(use.sampler) + ";\n";
    if (features & use.transform) uniforms += "uniform mat3x2 " + std::string(use.uvMatrix) + ";\n";
  }
  return header(features) + uniforms + kFragmentBody;
}

}  // namespace saccade::render
