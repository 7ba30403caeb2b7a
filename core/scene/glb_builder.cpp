#include "core/scene/glb_builder.h"

#include <limits>

#include "core/error.h"

namespace saccade::core {
namespace {

using nlohmann::json;

constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr std::size_t kMaxShortVertices = 65535;  // index 65535 is reserved for primitive restart
constexpr std::size_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

void pad(std::vector<std::uint8_t>& bytes, std::uint8_t with) {
  while (bytes.size() % 4 != 0) bytes.push_back(with);
}

void append32(std::vector<std::uint8_t>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void refuseBeyondGlb(std::size_t bytes) {
  if (bytes > std::numeric_limits<std::uint32_t>::max())
    throw Error("the file would have " + std::to_string(bytes >> 20) +
                " MiB, and a GLB holds at most 4095; export a smaller scene");
}

}  // namespace

template <class T>
int GlbBuilder::addAccessor(StreamKind kind, const char* type, int componentType,
                            const std::vector<T>& values) {
  std::vector<std::uint8_t>& stream = streams_[kind].data;
  accessors_.push_back({{"bufferView", kind},
                        {"byteOffset", stream.size()},
                        {"componentType", componentType},
                        {"count", values.size()},
                        {"type", type}});
  const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
  stream.insert(stream.end(), first, first + values.size() * sizeof(T));
  return static_cast<int>(accessors_.size()) - 1;
}

int GlbBuilder::addPositions(const std::vector<Vec3>& values) {
  Bounds bounds;
  for (const Vec3& p : values) bounds.add(p);
  const int accessor = addAccessor(kPositions, "VEC3", kFloat, values);
  accessors_.back()["min"] = jsonArray(bounds.lo);
  accessors_.back()["max"] = jsonArray(bounds.hi);
  return accessor;
}
int GlbBuilder::addNormals(const std::vector<Vec3>& values) {
  return addAccessor(kNormals, "VEC3", kFloat, values);
}
int GlbBuilder::addUvs(const std::vector<Vec2>& values) { return addAccessor(kUvs, "VEC2", kFloat, values); }
int GlbBuilder::addVec4s(const std::vector<Vec4>& values) {
  return addAccessor(kVec4s, "VEC4", kFloat, values);
}
int GlbBuilder::addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertexCount) {
  if (vertexCount > kMaxShortVertices) return addAccessor(kLongIndices, "SCALAR", kUnsignedInt, indices);
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  return addAccessor(kShortIndices, "SCALAR", kUnsignedShort, narrow);
}

int GlbBuilder::addImage(const std::string& name, std::vector<std::uint8_t> file, const char* mimeType) {
  imageFiles_.push_back(std::move(file));
  images_.push_back({{"mimeType", mimeType}});
  if (!name.empty()) images_.back()["name"] = name;
  return static_cast<int>(images_.size()) - 1;
}

json GlbBuilder::withBufferViews(std::vector<std::uint8_t>& binary) const {
  json whole = root, accessors = accessors_, images = images_;
  json views = json::array();
  const auto addView = [&](const std::vector<std::uint8_t>& data) -> json& {
    views.push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", data.size()}});
    binary.insert(binary.end(), data.begin(), data.end());
    pad(binary, 0);
    return views.back();
  };
  int viewOfStream[kStreamKinds] = {};
  for (int kind = 0; kind < kStreamKinds; ++kind) {
    if (streams_[kind].data.empty()) continue;
    viewOfStream[kind] = static_cast<int>(views.size());
    json& view = addView(streams_[kind].data);
    view["target"] = streams_[kind].target;
    if (streams_[kind].stride > 0) view["byteStride"] = streams_[kind].stride;
  }
  for (json& accessor : accessors) accessor["bufferView"] = viewOfStream[accessor["bufferView"].get<int>()];
  for (std::size_t i = 0; i < imageFiles_.size(); ++i) {
    images[i]["bufferView"] = views.size();
    addView(imageFiles_[i]);
  }
  whole["accessors"] = std::move(accessors);
  if (!images.empty()) whole["images"] = std::move(images);
  whole["bufferViews"] = std::move(views);
  whole["buffers"] = json::array({{{"byteLength", binary.size()}}});
  return whole;
}

void GlbBuilder::checkSize() const {
  std::size_t bytes = 0;
  for (const Stream& stream : streams_) bytes += stream.data.size();
  for (const auto& file : imageFiles_) bytes += file.size();
  refuseBeyondGlb(bytes);
}

std::vector<std::uint8_t> GlbBuilder::bytes(const std::string& generator) const {
  checkSize();  // before anything is copied
  std::vector<std::uint8_t> binary;
  json whole = withBufferViews(binary);
  whole["asset"] = {{"version", "2.0"}, {"generator", generator}};
  if (!extensionsUsed_.empty()) whole["extensionsUsed"] = extensionsUsed_;
  // Names may come from files whose text is not UTF-8.
  const std::string text = whole.dump(-1, ' ', false, json::error_handler_t::replace);
  std::vector<std::uint8_t> jsonChunk(text.begin(), text.end());
  pad(jsonChunk, ' ');

  const std::size_t size = kHeader + kChunkHeader + jsonChunk.size() + kChunkHeader + binary.size();
  refuseBeyondGlb(size);
  std::vector<std::uint8_t> file;
  file.reserve(size);
  append32(file, kMagic);
  append32(file, kVersion);
  append32(file, size);
  append32(file, jsonChunk.size());
  append32(file, kJsonChunk);
  file.insert(file.end(), jsonChunk.begin(), jsonChunk.end());
  append32(file, binary.size());
  append32(file, kBinaryChunk);
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

}  // namespace saccade::core
