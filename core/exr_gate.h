// The gate in front of OpenEXR: what a file's header claims, checked before OpenEXR allocates anything by it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace saccade::core {

struct ExrClaims {
  std::int64_t width = 0, height = 0;
  std::uint64_t bytesPerPixel = 0;  ///< of all channels
  /// What OpenEXR's line buffers take, in bytes.
  std::uint64_t workingBytes = 0;
};

/// Walks the header. Throws core::Error, starting with `name`: not EXR; tiled, deep or multi-part; an
/// attribute that reaches beyond the file; compression other than NONE, RLE, ZIP; subsampled channels or more
/// of them than 64; dimensions that are out of range or that the file's bytes cannot hold. Any thread.
ExrClaims checkExrHeader(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace saccade::core
