#include "core/scene_state.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/content_hash.h"
#include "core/maps.h"
#include "core/scene/texture_mean.h"

namespace saccade::core {
namespace {

template <class V>
void addVector(ContentHash& hash, const V& v) {
  for (int c = 0; c < V::length(); ++c) hash.add(v[c]);
}

/// `texture`: what stands for it.
template <class Number>
void addSlot(ContentHash& hash, const TextureSlot& slot, Number texture) {
  hash.add(texture);
  hash.add(slot.uvSet);
  addVector(hash, slot.offset);
  hash.add(slot.rotation);
  addVector(hash, slot.scale);
}

void addWard(ContentHash& hash, const std::optional<WardLobe>& ward) {
  hash.add(ward.has_value());
  if (!ward) return;
  addVector(hash, ward->diffuse);
  addVector(hash, ward->specular);
  hash.add(ward->alphaX);
  hash.add(ward->alphaY);
}

std::array<const TextureSlot*, 15> slotsOf(const Material& m) {
  return {&m.baseColorTexture,       &m.metallicRoughnessTexture, &m.normalTexture,
          &m.emissionTexture,        &m.specularTexture,          &m.specularColorTexture,
          &m.transmissionTexture,    &m.clearcoatTexture,         &m.clearcoatRoughnessTexture,
          &m.clearcoatNormalTexture, &m.anisotropyTexture,        &m.sheenColorTexture,
          &m.sheenRoughnessTexture,  &m.iridescenceTexture,       &m.iridescenceThicknessTexture};
}

/// All but its emission factor. `nameOf(texture)` stands for textures.
template <class NameOf>
void addMaterial(ContentHash& hash, const Material& m, NameOf&& nameOf) {
  addVector(hash, m.baseColor);
  addVector(hash, m.specularColor);
  addVector(hash, m.attenuationColor);
  addVector(hash, m.sheenColor);
  for (const float f : {m.alpha,
                        m.metallic,
                        m.roughness,
                        m.normalScale,
                        m.ior,
                        m.specular,
                        m.transmission,
                        m.alphaCutoff,
                        m.attenuationDistance,
                        m.dispersion,
                        m.clearcoat,
                        m.clearcoatRoughness,
                        m.clearcoatNormalScale,
                        m.anisotropy,
                        m.anisotropyRotation,
                        m.sheenRoughness,
                        m.iridescence,
                        m.iridescenceIor,
                        m.iridescenceThicknessMin,
                        m.iridescenceThicknessMax})
    hash.add(f);
  for (const TextureSlot* slot : slotsOf(m)) addSlot(hash, *slot, nameOf(slot->texture));
  addWard(hash, m.ward);
  hash.add(m.thinWalled);
  hash.add(m.alphaMode);
  hash.add(m.doubleSided);
  hash.add(m.unlit);
}

void addTexture(ContentHash& hash, const Texture& t) {
  hash.add(t.image.width());
  hash.add(t.image.height());
  const auto& pixels = t.image.pixels();
  static_assert(sizeof(Rgba8) == 4);
  hash.addArray(pixels);
  hash.add(t.wrapS);
  hash.add(t.wrapT);
  hash.add(t.nearest);
  hash.add(t.srgb);
}

/// Corner by corner, so that splitting vertices along chart borders changes nothing.
void addMesh(ContentHash& hash, const Mesh& m) {
  hash.add(m.instanced);
  hash.add(static_cast<std::uint64_t>(m.indices.size()));
  for (const bool has :
       {m.normals.empty(), m.tangents.empty(), m.uv0.empty(), m.uv1.empty(), m.colors.empty()})
    hash.add(has);
  for (const std::uint32_t i : m.indices) {
    addVector(hash, m.positions[i]);
    if (!m.normals.empty()) addVector(hash, m.normals[i]);
    if (!m.tangents.empty()) addVector(hash, m.tangents[i]);
    if (!m.uv0.empty()) addVector(hash, m.uv0[i]);
    if (!m.uv1.empty()) addVector(hash, m.uv1[i]);
    if (!m.colors.empty()) addVector(hash, m.colors[i]);
  }
}

void addObject(ContentHash& hash, const Object& o) {
  hash.add(o.material);
  hash.add(o.closed);
  hash.add(o.id != 0);
  hash.add(o.mesh);
  for (int c = 0; c < 4; ++c) addVector(hash, o.meshToWorld[c]);
}

void addLight(ContentHash& hash, const PunctualLight& l) {
  hash.add(l.type);
  addVector(hash, l.position);
  addVector(hash, l.direction);
  addVector(hash, l.intensity);
  for (const float f : {l.range, l.cosInner, l.cosOuter}) hash.add(f);
}

void addEnvironment(ContentHash& hash, const Environment& e) {
  hash.add(e.radiance.width());
  hash.add(e.radiance.height());
  const auto& pixels = e.radiance.pixels();
  static_assert(sizeof(Vec3) == 12);
  hash.addArray(pixels);
  hash.add(e.rotation);
}

template <class T, class Add>
std::vector<std::uint64_t> hashesOf(const std::vector<T>& items, Add&& add) {
  std::vector<std::uint64_t> out;
  for (const T& item : items) {
    ContentHash hash;
    add(hash, item);
    out.push_back(hash.value());
  }
  return out;
}

}  // namespace

Material plainMaterial(const Scene& scene, const Material& material) {
  const MaterialMeans means = materialMeans(scene, material);
  const auto mean = [&](const TextureSlot& slot) {
    return slot ? textureMean(scene.textures[static_cast<std::size_t>(slot.texture)]) : Vec4(1);
  };
  // What textures leave open stays open: a plain material shows irradiance where its original does.
  constexpr float kSome = 1e-3f;
  Material plain;
  plain.baseColor = glm::max(means.baseColor, kSome * material.baseColor);
  plain.alpha = means.alpha;
  plain.metallic = material.metallicRoughnessTexture ? std::min(means.metallic, 1 - kSome) : means.metallic;
  plain.roughness = means.roughness;
  plain.emission = material.emission * Vec3(mean(material.emissionTexture));
  plain.ior = material.ior;
  plain.specular = material.specular * mean(material.specularTexture).w;
  plain.specularColor = material.specularColor * Vec3(mean(material.specularColorTexture));
  plain.transmission =
      material.transmissionTexture ? std::min(means.transmission, 1 - kSome) : means.transmission;
  plain.thinWalled = material.thinWalled;
  plain.attenuationColor = material.attenuationColor;
  plain.attenuationDistance = material.attenuationDistance;
  if (material.alphaMode == AlphaMode::blend || (material.alphaMode == AlphaMode::mask && means.alpha < 1))
    plain.alphaMode = AlphaMode::blend;
  plain.doubleSided = material.doubleSided;
  plain.unlit = material.unlit;
  return plain;
}

SceneState sceneState(const Scene& scene) {
  SceneState state;
  state.lights = scene.lights;
  if (scene.environment) {
    ContentHash hash;
    addEnvironment(hash, *scene.environment);
    state.environment = hash.value();
  }
  const std::vector<std::uint64_t> meshes = hashesOf(scene.meshes, addMesh),
                                   textures = hashesOf(scene.textures, addTexture);
  const std::vector<std::uint64_t> looks =
      hashesOf(scene.materials, [&](ContentHash& hash, const Material& m) {
        addMaterial(hash, m,
                    [&](int t) { return t < 0 ? std::uint64_t{0} : textures[static_cast<std::size_t>(t)]; });
      });
  for (const Material& m : scene.materials) state.plain.materials.push_back(plainMaterial(scene, m));
  for (const Mesh& m : scene.meshes) {
    Mesh& plain = state.plain.meshes.emplace_back();
    plain.instanced = m.instanced;
    plain.positions = m.positions;
    plain.normals = m.normals;
    plain.indices = m.indices;
  }
  for (const Object& o : scene.objects) {
    const auto material = static_cast<std::size_t>(o.material);
    ContentHash shape, look;
    shape.add(meshes[o.mesh]);
    for (int c = 0; c < 4; ++c) addVector(shape, o.meshToWorld[c]);
    look.add(looks[material]);
    look.add(o.closed);
    look.add(o.id != 0);
    state.objects.push_back({shape.value(), look.value(), scene.materials[material].emission});
    state.plain.objects.push_back(o);
  }
  return state;
}

std::uint64_t sceneKey(const Scene& scene) {
  ContentHash hash;
  hash.add(kMapsVersion);
  hash.add(static_cast<std::uint64_t>(scene.objects.size()));
  for (const Object& o : scene.objects) addObject(hash, o);
  hash.add(static_cast<std::uint64_t>(scene.meshes.size()));
  for (const Mesh& m : scene.meshes) addMesh(hash, m);
  hash.add(static_cast<std::uint64_t>(scene.materials.size()));
  for (const Material& m : scene.materials) addMaterial(hash, m, [](int t) { return t; });
  hash.add(static_cast<std::uint64_t>(scene.textures.size()));
  for (const Texture& t : scene.textures) addTexture(hash, t);
  if (scene.environment) addEnvironment(hash, *scene.environment);
  for (const Material& m : scene.materials) addVector(hash, m.emission);
  hash.add(static_cast<std::uint64_t>(scene.lights.size()));
  for (const PunctualLight& l : scene.lights) addLight(hash, l);
  return hash.value();
}

}  // namespace saccade::core
