// Illumination map files.
//
// Magic, version, byte order mark, key, size, layers, photons, quality, texels, detail (height, blocks,
// texels), charts, places, checksum of all that precedes it. Numbers in the machine's byte order, which the
// mark tells.
#include <algorithm>
#include <array>
#include <cstring>

#include "core/atomic_file.h"
#include "core/byte_reader.h"
#include "core/content_hash.h"
#include "core/maps.h"

namespace saccade::core {
namespace {

constexpr std::array<char, 8> kMagic = {'S', 'A', 'C', 'M', 'A', 'P', 'S', '\n'};
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
  if (version != kMapsVersion)
    in.refuse("has version " + std::to_string(version) + ", must be " + std::to_string(kMapsVersion));
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

bool allFinite(const std::vector<std::uint16_t>& halves) {
  constexpr std::uint16_t kExponent = 0x7C00;
  return std::none_of(halves.begin(), halves.end(),
                      [](std::uint16_t h) { return (h & kExponent) == kExponent; });
}

void readTexels(ByteReader& in, IlluminationMaps& maps) {
  maps.texels = in.array<std::uint16_t>();
  const std::uint64_t wanted = std::uint64_t{3} * static_cast<std::uint64_t>(maps.width) *
                               static_cast<std::uint64_t>(maps.height) *
                               static_cast<std::uint64_t>(maps.layers);
  if (maps.texels.size() != wanted) in.refuse("holds another number of texels than its size says");
  if (!allFinite(maps.texels)) in.refuse("holds texels that are not finite");
}

void readDetail(ByteReader& in, IlluminationMaps& maps) {
  const auto height = in.number<std::uint32_t>();
  if (height > kLargestSide) in.refuse("states an impossible size of its detail");
  maps.detail.height = static_cast<int>(height);
  maps.detail.blocks = in.array<std::uint32_t>();
  maps.detail.texels = in.array<std::uint16_t>();
  if (!fits(maps.detail, maps.width, maps.height, maps.layers))
    in.refuse("holds detail that does not fit its texels");
  if (!allFinite(maps.detail.texels)) in.refuse("holds texels that are not finite");
}

MeshCharts readCharts(ByteReader& in) {
  MeshCharts charts;
  charts.sourceVertex = in.array<std::uint32_t>();
  charts.uv = in.array<Vec2>();
  charts.indices = in.array<std::uint32_t>();
  charts.perVertex = in.number<std::uint8_t>() != 0;
  const std::size_t vertices = charts.sourceVertex.size();
  const bool good = charts.uv.size() == vertices && charts.indices.size() % 3 == 0 &&
                    std::all_of(charts.indices.begin(), charts.indices.end(),
                                [&](std::uint32_t i) { return i < vertices; });
  if (!good) in.refuse("holds charts that do not fit together");
  return charts;
}

}  // namespace

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
  readDetail(in, maps);
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
  out.number(kMapsVersion);
  out.number(kByteOrder);
  out.number(maps.key);
  out.number(static_cast<std::uint32_t>(maps.width));
  out.number(static_cast<std::uint32_t>(maps.height));
  out.number(static_cast<std::uint32_t>(maps.layers));
  out.number(maps.photons);
  out.array(std::vector<char>(maps.quality.begin(), maps.quality.end()));
  out.array(maps.texels);
  out.number(static_cast<std::uint32_t>(maps.detail.height));
  out.array(maps.detail.blocks);
  out.array(maps.detail.texels);
  out.number<std::uint64_t>(maps.charts.meshes.size());
  for (const MeshCharts& c : maps.charts.meshes) {
    out.array(c.sourceVertex);
    out.array(c.uv);
    out.array(c.indices);
    out.number(static_cast<std::uint8_t>(c.perVertex));
  }
  out.array(maps.charts.places);
  out.number(checksum(out.bytes()));
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  writeFileAtomically(file, out.bytes());
}

}  // namespace saccade::core
