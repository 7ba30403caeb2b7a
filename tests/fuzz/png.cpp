// A PNG in memory. libpng checks every chunk's CRC; most mutations mend them, so that they reach what lies
// behind.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "core/image_io.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

constexpr std::size_t kSignature = 8, kLengthAndType = 8, kCrc = 4;

std::uint32_t bigEndian(const std::uint8_t* at) {
  return static_cast<std::uint32_t>(at[0]) << 24 | static_cast<std::uint32_t>(at[1]) << 16 |
         static_cast<std::uint32_t>(at[2]) << 8 | at[3];
}

void mendChecksums(std::uint8_t* data, std::size_t size) {
  std::size_t at = kSignature;
  while (at + kLengthAndType + kCrc <= size) {
    const std::size_t length = bigEndian(data + at);
    if (length > size - at - kLengthAndType - kCrc) return;
    std::uint8_t* crc = data + at + kLengthAndType + length;
    const auto value = static_cast<std::uint32_t>(crc32(0, data + at + 4, static_cast<uInt>(4 + length)));
    for (int i = 0; i < 4; ++i) crc[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    at += kLengthAndType + length + kCrc;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, maxSize);
  if (seed % 8 != 0) mendChecksums(data, mutated);
  return mutated;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saccade::fuzz::mayRefuse([&] { saccade::core::decodeImage({data, size}, "image"); });
  return 0;
}
