#include "core/maps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/atomic_file.h"
#include "core/byte_reader.h"
#include "core/cache_folder.h"
#include "core/content_hash.h"
#include "core/light_state.h"
#include "core/math/half.h"
#include "core/scene/mesh_repair.h"

namespace saccade::core {
namespace {

// The file: magic, version, byte order mark, key, size, layers, photons, quality, texels, charts, places,
// checksum of all that precedes it. Numbers in the machine's byte order, which the mark tells.
constexpr std::array<char, 8> kMagic = {'S', 'A', 'C', 'M', 'A', 'P', 'S', '\n'};
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::uint32_t kLargestSide = 65536;

class Writer {
 public:
  template <class T>
  void number(T value) {
    raw(&value, sizeof value);
  }
  template <class T>
  void array(const std::vector<T>& values) {
    number<std::uint64_t>(values.size());
    raw(values.data(), values.size() * sizeof(T));
  }
  void raw(const void* data, std::size_t bytes) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), from, from + bytes);
  }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.value();
}

void readHeader(ByteReader& in, IlluminationMaps& maps, std::uint64_t key) {
  if (in.number<std::array<char, 8>>() != kMagic) in.refuse("is none (wrong first bytes)");
  const auto version = in.number<std::uint32_t>();
  if (in.number<std::uint32_t>() != kByteOrder) in.refuse("was written on a machine of another byte order");
  if (version != kVersion)
    in.refuse("has version " + std::to_string(version) + ", must be " + std::to_string(kVersion));
  maps.key = in.number<std::uint64_t>();
  if (key != 0 && maps.key != key) in.refuse("belongs to another scene or another state of it");
  const auto width = in.number<std::uint32_t>(), height = in.number<std::uint32_t>(),
             layers = in.number<std::uint32_t>();
  if (width == 0 || height == 0 || width > kLargestSide || height > kLargestSide || layers < 1 || layers > 2)
    in.refuse("states an impossible size");
  maps.width = static_cast<int>(width);
  maps.height = static_cast<int>(height);
  maps.layers = static_cast<int>(layers);
  maps.photons = in.number<std::uint64_t>();
  const std::vector<char> quality = in.array<char>();
  maps.quality.assign(quality.begin(), quality.end());
}

void readTexels(ByteReader& in, IlluminationMaps& maps) {
  maps.texels = in.array<std::uint16_t>();
  const std::uint64_t wanted = std::uint64_t{3} * static_cast<std::uint64_t>(maps.width) *
                               static_cast<std::uint64_t>(maps.height) *
                               static_cast<std::uint64_t>(maps.layers);
  if (maps.texels.size() != wanted) in.refuse("holds another number of texels than its size says");
  constexpr std::uint16_t kExponent = 0x7C00;
  if (std::any_of(maps.texels.begin(), maps.texels.end(),
                  [](std::uint16_t t) { return (t & kExponent) == kExponent; }))
    in.refuse("holds texels that are not finite");
}

MeshCharts readCharts(ByteReader& in) {
  MeshCharts charts;
  charts.sourceVertex = in.array<std::uint32_t>();
  charts.uv = in.array<Vec2>();
  charts.indices = in.array<std::uint32_t>();
  const std::size_t vertices = charts.sourceVertex.size();
  const bool good = charts.uv.size() == vertices && charts.indices.size() % 3 == 0 &&
                    std::all_of(charts.indices.begin(), charts.indices.end(),
                                [&](std::uint32_t i) { return i < vertices; });
  if (!good) in.refuse("holds charts that do not fit together");
  return charts;
}

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
  hash.add(kVersion);
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

IlluminationMaps readMaps(const std::filesystem::path& file, std::uint64_t key) {
  const std::vector<std::uint8_t> bytes = readWholeFile(file);
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  const std::size_t body = bytes.size() < kSum ? 0 : bytes.size() - kSum;
  const std::span<const std::uint8_t> content(bytes.data(), body);
  ByteReader in(content, file.string(), "illumination map file", "bake again");
  IlluminationMaps maps;
  readHeader(in, maps, key);
  std::uint64_t stated = 0;
  std::memcpy(&stated, bytes.data() + body, kSum);
  if (stated != checksum(content)) in.refuse("is damaged or cut off (checksum)");
  readTexels(in, maps);
  const auto meshes = in.number<std::uint64_t>();
  if (meshes > body) in.refuse("states an impossible number of meshes");
  for (std::uint64_t m = 0; m < meshes; ++m) maps.charts.meshes.push_back(readCharts(in));
  maps.charts.places = in.array<Vec4>();
  if (!in.atEnd()) in.refuse("has bytes after its end");
  return maps;
}

void writeMaps(const std::filesystem::path& file, const IlluminationMaps& maps) {
  Writer out;
  out.number(kMagic);
  out.number(kVersion);
  out.number(kByteOrder);
  out.number(maps.key);
  out.number(static_cast<std::uint32_t>(maps.width));
  out.number(static_cast<std::uint32_t>(maps.height));
  out.number(static_cast<std::uint32_t>(maps.layers));
  out.number(maps.photons);
  out.array(std::vector<char>(maps.quality.begin(), maps.quality.end()));
  out.array(maps.texels);
  out.number<std::uint64_t>(maps.charts.meshes.size());
  for (const MeshCharts& c : maps.charts.meshes) {
    out.array(c.sourceVertex);
    out.array(c.uv);
    out.array(c.indices);
  }
  out.array(maps.charts.places);
  out.number(checksum(out.bytes()));
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  writeFileAtomically(file, out.bytes());
}

}  // namespace saccade::core
