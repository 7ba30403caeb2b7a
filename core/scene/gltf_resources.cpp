#include "core/scene/gltf_resources.h"

#include <string_view>

#include "core/image_io.h"
#include "core/scene/confined_file.h"

namespace saccade::core {
namespace {

using Bytes = std::vector<std::uint8_t>;

int base64Value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

Bytes decodeDataUri(const std::string& uri, const std::string& who, LoadBudget& budget) {
  static constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (mark == std::string::npos || mark > uri.find(',')) throw Error(who + ": data URI is not base64");
  Bytes out;
  budget.charge((uri.size() - mark) * 3 / 4, who);
  out.reserve((uri.size() - mark) * 3 / 4);
  std::uint32_t bits = 0;
  int have = 0;
  for (std::size_t i = mark + kMark.size(); i < uri.size() && uri[i] != '='; ++i) {
    const int value = base64Value(uri[i]);
    if (value < 0) throw Error(who + ": data URI holds a character that is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    have += 6;
    if (have >= 8) out.push_back(static_cast<std::uint8_t>(bits >> (have -= 8)));
  }
  return out;
}

std::string decodePercent(const std::string& uri, const std::string& who) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out.push_back(uri[i]);
      continue;
    }
    const int high = i + 2 < uri.size() ? hex(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex(uri[i + 2]) : -1;
    if (high < 0 || low < 0) throw Error(who + ": URI holds a broken % escape");
    out.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return out;
}

/// The media type of a data URI, "" if it gives none.
std::string mediaType(const std::string& uri) {
  const std::size_t from = std::string_view("data:").size();
  return uri.substr(from, uri.find_first_of(";,", from) - from);
}

Bytes resolve(const Element& owner, const GltfSource& source) {
  const std::string uri = owner.text("uri");
  if (uri.starts_with("data:")) return decodeDataUri(uri, owner.path(), source.budget);
  const std::size_t colon = uri.find(':');
  if (colon != std::string::npos && uri.find('/') > colon)
    owner.refuse("URI has the scheme '" + uri.substr(0, colon) +
                 "'; only data: and files beside the scene are read");
  return readSceneFile(confinedFile(source.folder, decodePercent(uri, owner.path()), owner.path()),
                       source.budget);
}

Bytes readBuffer(const Element& buffer, bool first, const GltfSource& source) {
  if (!buffer.has("uri")) {
    if (!first || source.parts.bin.empty()) {
      const std::uint64_t length = buffer.integer("byteLength", 1, kMaxSceneBytes);
      source.repairs.add("buffers have neither a URI nor the file's binary chunk and were taken as zeros",
                         buffer.path());
      source.budget.charge(length, buffer.path());
      return Bytes(length, 0);
    }
    source.budget.charge(source.parts.bin.size(), buffer.path());
    return {source.parts.bin.begin(), source.parts.bin.end()};
  }
  const std::string uri = buffer.text("uri");
  if (uri.starts_with("data:")) {
    const std::string type = mediaType(uri);
    if (type != "application/octet-stream" && type != "application/gltf-buffer")
      source.repairs.add("buffers' data URIs state another type than glTF's and were read all the same",
                         buffer.path());
  }
  return resolve(buffer, source);
}

Bytes imageBytes(const Element& image, const std::vector<Element>& views, const std::vector<Bytes>& buffers,
                 const GltfSource& source) {
  if (image.has("uri") == image.has("bufferView")) image.refuse("must have either 'uri' or 'bufferView'");
  if (image.has("uri")) return resolve(image, source);
  const Element& view = views[image.index("bufferView", views.size(), "bufferViews")];
  const Bytes& buffer = buffers[view.index("buffer", buffers.size(), "buffers")];
  const auto from =
      buffer.begin() + static_cast<std::ptrdiff_t>(view.integerOr("byteOffset", 0, 0, buffer.size()));
  const std::uint64_t length = view.integer("byteLength", 1, buffer.size());
  source.budget.charge(length, image.path());
  return Bytes(from, from + static_cast<std::ptrdiff_t>(length));
}

/// Content decides; a stated type that is another is reported.
void checkType(const Element& image, const std::string& actual, Repairs& repairs) {
  std::vector<std::string> stated;
  if (image.has("mimeType")) stated.push_back(image.text("mimeType"));
  if (image.has("uri") && image.text("uri").starts_with("data:"))
    stated.push_back(mediaType(image.text("uri")));
  for (const std::string& type : stated)
    if (type != actual)
      repairs.add("images state another type than theirs; the content decides", image.path());
  if (image.has("bufferView") && !image.has("mimeType"))
    repairs.add("images in a bufferView lack their 'mimeType'; the content decides", image.path());
}

}  // namespace

std::vector<Bytes> readBuffers(const Element& root, const GltfSource& source) {
  std::vector<Bytes> out;
  for (const Element& buffer : root.array("buffers")) {
    const std::uint64_t length = buffer.integer("byteLength", 1, kMaxSceneBytes);
    Bytes bytes = readBuffer(buffer, out.empty(), source);
    if (bytes.size() < length)
      buffer.refuse("states " + std::to_string(length) + " bytes, has " + std::to_string(bytes.size()));
    const bool embedded = buffer.has("uri") && buffer.text("uri").starts_with("data:");
    if (bytes.size() > length && embedded)
      source.repairs.add("buffers' data URIs are longer than stated; what is over was ignored",
                         buffer.path());
    bytes.resize(static_cast<std::size_t>(length));
    out.push_back(std::move(bytes));
  }
  return out;
}

std::vector<EncodedImage> readImages(const Element& root, const std::vector<Bytes>& buffers,
                                     const GltfSource& source) {
  const auto views = root.array("bufferViews");
  std::vector<EncodedImage> out;
  for (const Element& image : root.array("images")) {
    source.budget.checkTime();
    Bytes bytes = imageBytes(image, views, buffers, source);
    const std::string type = imageType(bytes);
    checkType(image, type, source.repairs);
    if (type.empty()) {
      source.repairs.add("images are neither PNG nor JPEG and were left out", image.path());
      bytes.clear();
    } else {
      checkImageHeader(bytes, image.path());
    }
    out.push_back({image.path(), std::move(bytes)});
  }
  return out;
}

}  // namespace saccade::core
