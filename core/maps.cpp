#include "core/maps.h"

#include <algorithm>

#include "core/cache_folder.h"
#include "core/content_hash.h"
#include "core/light_state.h"
#include "core/math/half.h"
#include "core/scene/mesh_repair.h"

namespace saccade::core {
namespace {

template <class V>
void addVector(ContentHash& hash, const V& v) {
  for (int c = 0; c < V::length(); ++c) hash.add(v[c]);
}

void addSlot(ContentHash& hash, const TextureSlot& slot) {
  hash.add(slot.texture);
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

/// All but its emission factor.
void addMaterial(ContentHash& hash, const Material& m) {
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
  for (const TextureSlot* slot :
       {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissionTexture,
        &m.specularTexture, &m.specularColorTexture, &m.transmissionTexture, &m.clearcoatTexture,
        &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture, &m.anisotropyTexture, &m.sheenColorTexture,
        &m.sheenRoughnessTexture, &m.iridescenceTexture, &m.iridescenceThicknessTexture})
    addSlot(hash, *slot);
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
  hash.add(std::span(reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size() * sizeof(Rgba8)));
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
  hash.add(std::span(reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size() * sizeof(Vec3)));
  hash.add(e.rotation);
}

void checkCounts(const Scene& scene, const SceneCharts& charts) {
  if (charts.meshes.size() == scene.meshes.size() && charts.places.size() == scene.objects.size()) return;
  throw Error(scene.path + ": the charts are for " + std::to_string(charts.meshes.size()) + " meshes and " +
              std::to_string(charts.places.size()) + " objects, the scene has " +
              std::to_string(scene.meshes.size()) + " and " + std::to_string(scene.objects.size()));
}

/// All but what shines.
ContentHash unlitHash(const Scene& scene) {
  ContentHash hash;
  hash.add(kMapsVersion);
  hash.add(static_cast<std::uint64_t>(scene.objects.size()));
  for (const Object& o : scene.objects) addObject(hash, o);
  hash.add(static_cast<std::uint64_t>(scene.meshes.size()));
  for (const Mesh& m : scene.meshes) addMesh(hash, m);
  hash.add(static_cast<std::uint64_t>(scene.materials.size()));
  for (const Material& m : scene.materials) addMaterial(hash, m);
  hash.add(static_cast<std::uint64_t>(scene.textures.size()));
  for (const Texture& t : scene.textures) addTexture(hash, t);
  if (scene.environment) addEnvironment(hash, *scene.environment);
  return hash;
}

}  // namespace

Vec3 IlluminationMaps::texel(int x, int y, int layer) const {
  const auto column = static_cast<std::size_t>(std::clamp(x, 0, width - 1));
  const auto row = static_cast<std::size_t>(std::clamp(y, 0, height - 1));
  const auto plane = static_cast<std::size_t>(std::clamp(layer, 0, layers - 1));
  const std::size_t at =
      ((plane * static_cast<std::size_t>(height) + row) * static_cast<std::size_t>(width) + column) * 3;
  return Vec3(fromHalf(texels[at]), fromHalf(texels[at + 1]), fromHalf(texels[at + 2]));
}

std::size_t IlluminationMaps::lightBytes() const {
  return (texels.size() + detail.texels.size()) * sizeof(std::uint16_t) +
         detail.blocks.size() * sizeof(std::uint32_t);
}

void applyCharts(Scene& scene, const SceneCharts& charts) {
  checkCounts(scene, charts);
  for (std::size_t m = 0; m < charts.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    const MeshCharts& c = charts.meshes[m];
    const bool fits = c.indices.size() == mesh.indices.size() && c.uv.size() == c.sourceVertex.size() &&
                      std::all_of(c.sourceVertex.begin(), c.sourceVertex.end(),
                                  [&](std::uint32_t v) { return v < mesh.positions.size(); });
    if (!fits) throw Error(scene.path + ": the charts of mesh " + std::to_string(m) + " do not fit it");
    mesh = gatherVertices(mesh, c.sourceVertex);
    mesh.indices = c.indices;
  }
  placeCharts(scene, charts);
}

void placeCharts(Scene& scene, const SceneCharts& charts) {
  checkCounts(scene, charts);
  for (std::size_t m = 0; m < charts.meshes.size(); ++m) {
    if (charts.meshes[m].uv.size() != scene.meshes[m].positions.size())
      throw Error(scene.path + ": the charts of mesh " + std::to_string(m) + " do not fit it");
    scene.meshes[m].lightmapUv = charts.meshes[m].uv;
  }
  for (std::size_t o = 0; o < charts.places.size(); ++o)
    scene.objects[o].lightmapScaleOffset = charts.places[o];
}

std::uint64_t sceneKey(const Scene& scene) {
  ContentHash hash = unlitHash(scene);
  for (const Material& m : scene.materials) addVector(hash, m.emission);
  hash.add(static_cast<std::uint64_t>(scene.lights.size()));
  for (const PunctualLight& l : scene.lights) addLight(hash, l);
  return hash.value();
}

std::uint64_t unlitSceneKey(const Scene& scene) { return unlitHash(scene).value(); }

LightState lightState(const Scene& scene) {
  LightState state;
  state.unlitKey = unlitSceneKey(scene);
  state.lights = scene.lights;
  for (const Material& m : scene.materials) state.emission.push_back(m.emission);
  return state;
}

std::filesystem::path defaultMapsPath(std::uint64_t key, const std::string& settings) {
  ContentHash hash;
  hash.add(key);
  hash.add(settings);
  return cacheFolder() / (cacheName(hash.value()) + ".maps");
}

}  // namespace saccade::core
