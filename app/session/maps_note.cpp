#include "app/session/maps_note.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "core/atomic_file.h"
#include "core/byte_reader.h"
#include "core/content_hash.h"

namespace saccade::app {
namespace {

constexpr std::array<char, 8> kMagic = {'S', 'A', 'C', 'N', 'O', 'T', 'E', '3'};

class Writer {
 public:
  template <class T>
  void number(const T& value) {
    raw(&value, sizeof value);
  }
  template <class Values>
  void array(const Values& values) {
    static_assert(std::is_trivially_copyable_v<typename Values::value_type>);
    number<std::uint64_t>(values.size());
    raw(values.data(), values.size() * sizeof(typename Values::value_type));
  }
  std::vector<std::uint8_t> bytes;

 private:
  void raw(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), from, from + size);
  }
};

std::string text(core::ByteReader& in) {
  const std::vector<char> characters = in.array<char>();
  return {characters.begin(), characters.end()};
}

/// Reads or writes each field by `field`, in the order of the file.
template <class Light, class Field>
void forEachField(Light& l, Field&& field) {
  field(l.position);
  field(l.direction);
  field(l.intensity);
  field(l.range);
  field(l.cosInner);
  field(l.cosOuter);
}

/// Of a plain material.
template <class M, class Field>
void forEachMaterialField(M& m, Field&& field) {
  for (auto* v : {&m.baseColor, &m.emission, &m.specularColor, &m.attenuationColor}) field(*v);
  for (auto* f :
       {&m.alpha, &m.metallic, &m.roughness, &m.ior, &m.specular, &m.transmission, &m.attenuationDistance})
    field(*f);
  for (auto* b : {&m.thinWalled, &m.doubleSided, &m.unlit}) field(*b);
}

void writeLights(Writer& out, const std::vector<core::PunctualLight>& lights) {
  out.number<std::uint64_t>(lights.size());
  for (const core::PunctualLight& l : lights) {
    out.number(static_cast<std::uint32_t>(l.type));
    out.array(l.name);
    forEachField(l, [&](const auto& value) { out.number(value); });
  }
}

std::vector<core::PunctualLight> readLights(core::ByteReader& in) {
  std::vector<core::PunctualLight> lights;
  const auto count = in.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    core::PunctualLight l;
    l.type = static_cast<core::PunctualLight::Type>(in.number<std::uint32_t>());
    l.name = text(in);
    forEachField(l, [&](auto& value) { value = in.number<std::remove_reference_t<decltype(value)>>(); });
    lights.push_back(std::move(l));
  }
  return lights;
}

void writeScene(Writer& out, const core::Scene& scene) {
  out.number<std::uint64_t>(scene.materials.size());
  for (const core::Material& m : scene.materials) {
    forEachMaterialField(m, [&](const auto& value) { out.number(value); });
    out.number(m.alphaMode == core::AlphaMode::blend);
  }
  out.number<std::uint64_t>(scene.meshes.size());
  for (const core::Mesh& m : scene.meshes) {
    out.number(m.instanced);
    out.array(m.positions);
    out.array(m.normals);
    out.array(m.indices);
  }
  out.number<std::uint64_t>(scene.objects.size());
  for (const core::Object& o : scene.objects) {
    out.array(o.name);
    out.number<std::uint32_t>(static_cast<std::uint32_t>(o.material));
    out.number(o.mesh);
    out.number(o.id);
    out.number(o.closed);
    out.number(o.meshToWorld);
    out.number(o.bounds.lo);
    out.number(o.bounds.hi);
  }
}

void readMaterials(core::ByteReader& in, core::Scene& scene) {
  const auto count = in.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    core::Material& m = scene.materials.emplace_back();
    forEachMaterialField(m,
                         [&](auto& value) { value = in.number<std::remove_reference_t<decltype(value)>>(); });
    if (in.number<bool>()) m.alphaMode = core::AlphaMode::blend;
  }
}

void readMeshes(core::ByteReader& in, core::Scene& scene) {
  const auto count = in.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    core::Mesh& m = scene.meshes.emplace_back();
    m.instanced = in.number<bool>();
    m.positions = in.array<core::Vec3>();
    m.normals = in.array<core::Vec3>();
    m.indices = in.array<std::uint32_t>();
    const std::size_t vertices = m.positions.size();
    if (m.normals.size() != vertices || m.indices.size() % 3 != 0 ||
        std::any_of(m.indices.begin(), m.indices.end(), [&](std::uint32_t v) { return v >= vertices; }))
      in.refuse("holds a mesh that does not fit together");
  }
}

void readObjects(core::ByteReader& in, core::Scene& scene) {
  const auto count = in.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    core::Object& o = scene.objects.emplace_back();
    o.name = text(in);
    const auto material = in.number<std::uint32_t>();
    o.material = static_cast<int>(material);
    o.mesh = in.number<std::uint32_t>();
    o.id = in.number<std::uint32_t>();
    o.closed = in.number<bool>();
    o.meshToWorld = in.number<core::Mat4>();
    o.bounds.lo = in.number<core::Vec3>();
    o.bounds.hi = in.number<core::Vec3>();
    if (material >= scene.materials.size() || o.mesh >= scene.meshes.size())
      in.refuse("holds an object without mesh or material");
  }
}

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  core::ContentHash hash;
  hash.add(bytes);
  return hash.value();
}

}  // namespace

MapsNote readNote(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  std::uint64_t stated = 0;
  const std::size_t body = bytes.size() < sizeof stated ? 0 : bytes.size() - sizeof stated;
  const std::span<const std::uint8_t> content(bytes.data(), body);
  core::ByteReader in(content, file.string(), "note of maps", "it is of no use");
  if (in.number<std::array<char, 8>>() != kMagic) in.refuse("is none");
  std::memcpy(&stated, bytes.data() + body, sizeof stated);
  if (checksum(content) != stated) in.refuse("is damaged");
  MapsNote note;
  note.maps = text(in);
  note.key = in.number<std::uint64_t>();
  note.light = in.number<std::uint64_t>();
  note.scene.drift = in.number<double>();
  core::SceneState& state = note.scene.state;
  state.environment = in.number<std::uint64_t>();
  state.lights = readLights(in);
  state.objects = in.array<core::ObjectState>();
  readMaterials(in, state.plain);
  readMeshes(in, state.plain);
  readObjects(in, state.plain);
  if (state.objects.size() != state.plain.objects.size()) in.refuse("holds objects that do not fit together");
  return note;
}

void writeNote(const std::filesystem::path& file, const MapsNote& note) {
  Writer out;
  out.number(kMagic);
  out.array(note.maps);
  out.number(note.key);
  out.number(note.light);
  out.number(note.scene.drift);
  out.number(note.scene.state.environment);
  writeLights(out, note.scene.state.lights);
  out.array(note.scene.state.objects);
  writeScene(out, note.scene.state.plain);
  out.number(checksum(out.bytes));
  core::writeFileAtomically(file, out.bytes);
}

}  // namespace saccade::app
