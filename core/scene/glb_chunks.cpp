#include "core/scene/glb_chunks.h"

#include "core/error.h"

namespace saccade::core {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t word(Bytes bytes, std::size_t at) {
  std::uint32_t w = 0;
  for (std::size_t i = 4; i-- > 0;) w = w << 8 | bytes[at + i];
  return w;
}

/// The file without what lies behind its stated length.
Bytes checkHeader(Bytes bytes, const std::string& file, Repairs& repairs) {
  if (bytes.size() < kHeader + kChunkHeader) throw Error(file + ": GLB is cut off in its header");
  if (word(bytes, 4) != kVersion)
    throw Error(file + ": GLB version " + std::to_string(word(bytes, 4)) + ", must be 2");
  const std::uint32_t length = word(bytes, 8);
  if (length < kHeader + kChunkHeader || length > bytes.size())
    throw Error(file + ": GLB states " + std::to_string(length) + " bytes, the file has " +
                std::to_string(bytes.size()));
  if (length < bytes.size())
    repairs.add("bytes behind the end of the GLB were ignored", file, bytes.size() - length);
  return bytes.first(length);
}

}  // namespace

GltfParts splitGlb(Bytes whole, const std::string& file, Repairs& repairs) {
  if (whole.size() < 4 || word(whole, 0) != kMagic) return {whole, {}, false};
  const Bytes bytes = checkHeader(whole, file, repairs);
  GltfParts parts;
  parts.binary = true;
  std::size_t at = kHeader;
  int chunk = 0;
  const auto where = [&] { return file + ": GLB chunk " + std::to_string(chunk); };
  for (; at < bytes.size(); ++chunk) {
    if (bytes.size() - at < kChunkHeader) throw Error(where() + " is cut off in its header");
    const std::uint32_t size = word(bytes, at), type = word(bytes, at + 4);
    at += kChunkHeader;
    if (size > bytes.size() - at) throw Error(where() + " reaches beyond the file");
    if ((chunk == 0) != (type == kJsonChunk))
      throw Error(where() + " is wrong: there must be one JSON chunk, the first");
    if (size % 4 != 0) repairs.add("GLB chunks are not padded to 4 bytes", where());
    if (chunk == 0) parts.json = bytes.subspan(at, size);
    if (chunk == 1 && type == kBinChunk) parts.bin = bytes.subspan(at, size);
    if (chunk > 1 && type == kBinChunk)
      repairs.add("GLB chunks of binary data but the first were ignored", where());
    at += size;
  }
  return parts;
}

}  // namespace saccade::core
