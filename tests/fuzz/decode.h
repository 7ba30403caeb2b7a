// The image targets' common part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/error.h"
#include "core/image_io.h"

namespace saccade::fuzz {

inline void decodeOrRefuse(std::span<const std::uint8_t> bytes) {
  try {
    core::decodeImage(bytes, "image");
  } catch (const core::Error&) {
  }
}

}  // namespace saccade::fuzz
