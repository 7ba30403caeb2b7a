// The accessors of a glTF file over the bytes they name, for checks of their contents.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/gltf_element.h"

namespace saccade::core {

/// An accessor whose ranges were checked. Elements lie `stride` apart from `data`; null data means zeros.
struct GltfAccessor {
  std::uint64_t count = 0, components = 1, componentType = 5126, stride = 0;
  bool normalized = false;
  const std::uint8_t* data = nullptr;
  struct Sparse {
    std::uint64_t count = 0, indexBytes = 1;
    const std::uint8_t* indices = nullptr;
    const std::uint8_t* values = nullptr;
  } sparse;
};

/// All components of all elements, element after element, sparse substitution done; normalised integers as in
/// glTF 2.0, 3.6.2.2.
std::vector<float> contentsOf(const GltfAccessor& accessor);

/// Reads a little-endian unsigned integer of 1, 2 or 4 bytes.
std::uint32_t unsignedFrom(const std::uint8_t* at, std::uint64_t bytes);

}  // namespace saccade::core
