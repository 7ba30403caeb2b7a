// A .glb file. Most mutations keep the container whole, so that they reach what lies behind it: one chunk is
// changed and the lengths follow.
#include <algorithm>
#include <cstring>
#include <vector>

#include "tests/fuzz/fuzz_file.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBin = 0x004E4942;

std::uint32_t word(const std::uint8_t* at) {
  std::uint32_t value = 0;
  std::memcpy(&value, at, sizeof value);
  return value;
}

void append(Bytes& out, std::uint32_t value) {
  const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), from, from + sizeof value);
}

/// The first two chunks; false when the container is broken.
bool split(const std::uint8_t* data, std::size_t size, Bytes (&chunks)[2]) {
  if (size < kHeader + kChunkHeader || word(data) != kMagic) return false;
  std::size_t at = kHeader;
  for (Bytes& chunk : chunks) {
    if (at + kChunkHeader > size) return true;
    const std::size_t length = word(data + at);
    at += kChunkHeader;
    if (length > size - at) return false;
    chunk.assign(data + at, data + at + length);
    at += length;
  }
  return true;
}

Bytes join(Bytes (&chunks)[2]) {
  while (chunks[0].size() % 4 != 0) chunks[0].push_back(' ');
  while (chunks[1].size() % 4 != 0) chunks[1].push_back(0);
  Bytes out;
  append(out, kMagic);
  append(out, 2);
  append(out, static_cast<std::uint32_t>(kHeader + 2 * kChunkHeader + chunks[0].size() + chunks[1].size()));
  for (int c = 0; c < 2; ++c) {
    append(out, static_cast<std::uint32_t>(chunks[c].size()));
    append(out, c == 0 ? kJson : kBin);
    out.insert(out.end(), chunks[c].begin(), chunks[c].end());
  }
  return out;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
  Bytes chunks[2];
  if (seed % 8 == 0 || !split(data, size, chunks)) return LLVMFuzzerMutate(data, size, maxSize);
  Bytes& chunk = chunks[seed % 4 == 1 ? 1 : 0];
  const std::size_t length = chunk.size(), room = 64;
  chunk.resize(length + room);
  chunk.resize(LLVMFuzzerMutate(chunk.data(), length, length + room));
  const Bytes whole = join(chunks);
  if (whole.size() > maxSize) return LLVMFuzzerMutate(data, size, maxSize);
  std::copy(whole.begin(), whole.end(), data);
  return whole.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saccade::fuzz::loadScene(saccade::fuzz::scratch().write("scene.glb", {data, size}));
  return 0;
}
