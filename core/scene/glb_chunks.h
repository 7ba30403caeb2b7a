// The container of binary glTF (glTF 2.0, 4.4).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/scene/repairs.h"

namespace saccade::core {

struct GltfParts {
  std::span<const std::uint8_t> json;
  std::span<const std::uint8_t> bin;
  bool binary = false;  ///< a GLB, with or without a BIN chunk
};

/// The JSON and BIN chunks of a GLB, or, by content, the whole file as JSON. They point into `bytes`. Throws
/// core::Error, starting with `file`, for a header, length or chunk that does not fit the file. Any thread.
GltfParts splitGlb(std::span<const std::uint8_t> bytes, const std::string& file, Repairs& repairs);

}  // namespace saccade::core
