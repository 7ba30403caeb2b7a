#include "app/session/earlier_maps.h"

#include <spdlog/spdlog.h>

#include <array>
#include <cstring>

#include "core/atomic_file.h"
#include "core/byte_reader.h"
#include "core/cache_folder.h"
#include "core/content_hash.h"

namespace saccade::app {
namespace {

constexpr std::array<char, 8> kMagic = {'S', 'A', 'C', 'N', 'O', 'T', 'E', '1'};

std::filesystem::path noteFile(const core::Scene& scene, const std::string& settings) {
  core::ContentHash hash;
  hash.add(std::filesystem::absolute(scene.path).lexically_normal().string());
  hash.add(settings);
  return core::cacheFolder() / (core::cacheName(hash.value()) + ".newest");
}

struct Note {
  std::string maps;
  std::uint64_t key = 0;
  raytrace::EarlierLight light;
};

class Writer {
 public:
  template <class T>
  void number(const T& value) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof value);
  }
  template <class Values>
  void array(const Values& values) {
    number<std::uint64_t>(values.size());
    for (const auto& value : values) number(value);
  }
  std::vector<std::uint8_t> bytes;
};

std::vector<std::uint8_t> bytesOf(const Note& note) {
  Writer out;
  out.number(kMagic);
  out.array(note.maps);
  out.number(note.key);
  out.number(note.light.drift);
  out.number(note.light.state.unlitKey);
  out.array(note.light.state.emission);
  out.number<std::uint64_t>(note.light.state.lights.size());
  for (const core::PunctualLight& l : note.light.state.lights) {
    out.number(static_cast<std::uint32_t>(l.type));
    out.array(l.name);
    for (const core::Vec3& v : {l.position, l.direction, l.intensity}) out.number(v);
    for (const float f : {l.range, l.cosInner, l.cosOuter}) out.number(f);
  }
  core::ContentHash sum;
  sum.add(out.bytes);
  out.number(sum.value());
  return out.bytes;
}

std::string text(core::ByteReader& in) {
  const std::vector<char> characters = in.array<char>();
  return {characters.begin(), characters.end()};
}

Note readNote(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  std::uint64_t stated = 0;
  const std::size_t body = bytes.size() < sizeof stated ? 0 : bytes.size() - sizeof stated;
  const std::span<const std::uint8_t> content(bytes.data(), body);
  core::ByteReader in(content, file.string(), "note of maps", "it is of no use");
  if (in.number<std::array<char, 8>>() != kMagic) in.refuse("is none");
  std::memcpy(&stated, bytes.data() + body, sizeof stated);
  core::ContentHash sum;
  sum.add(content);
  if (sum.value() != stated) in.refuse("is damaged");
  Note note;
  note.maps = text(in);
  note.key = in.number<std::uint64_t>();
  note.light.drift = in.number<double>();
  note.light.state.unlitKey = in.number<std::uint64_t>();
  note.light.state.emission = in.array<core::Vec3>();
  const auto lights = in.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < lights; ++i) {
    core::PunctualLight l;
    l.type = static_cast<core::PunctualLight::Type>(in.number<std::uint32_t>());
    l.name = text(in);
    for (core::Vec3* v : {&l.position, &l.direction, &l.intensity}) *v = in.number<core::Vec3>();
    for (float* f : {&l.range, &l.cosInner, &l.cosOuter}) *f = in.number<float>();
    note.light.state.lights.push_back(l);
  }
  return note;
}

}  // namespace

std::optional<EarlierMaps> earlierMaps(const core::Scene& scene, const std::string& settings) {
  try {
    const std::filesystem::path file = noteFile(scene, settings);
    if (!std::filesystem::exists(file)) return std::nullopt;
    Note note = readNote(file);
    if (note.key == core::sceneKey(scene) || !std::filesystem::exists(note.maps)) return std::nullopt;
    if (note.light.state.unlitKey != core::unlitSceneKey(scene)) {
      spdlog::info("more than lights changed since {}: baking everything", note.maps);
      return std::nullopt;
    }
    return EarlierMaps{core::readMaps(note.maps, note.key), std::move(note.light)};
  } catch (const core::Error&) {
    return std::nullopt;  // maps or notes that cannot be read are of no use here
  }
}

void rememberMaps(const core::Scene& scene, const std::string& settings, const std::filesystem::path& file,
                  double drift) {
  try {
    const std::filesystem::path note = noteFile(scene, settings);
    std::error_code ignored;  // writing says what is wrong
    std::filesystem::create_directories(note.parent_path(), ignored);
    core::writeFileAtomically(note, bytesOf({std::filesystem::absolute(file).string(),
                                             core::sceneKey(scene),
                                             {core::lightState(scene), drift}}));
  } catch (const core::Error& e) {
    spdlog::debug("{}", e.what());
  }
}

}  // namespace saccade::app
