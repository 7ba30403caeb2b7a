// The accessors of a glTF file over the bytes they name, for checks of their contents.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/gltf_element.h"

namespace saccade::core {

/// An accessor whose ranges were checked. Elements lie `stride` apart from `data`; null data means zeros.
struct GltfAccessor {
  std::uint64_t count = 0, components = 1, componentType = 5126, stride = 0;
  std::uint64_t rows = 1;  ///< of a matrix, whose columns start at multiples of 4 bytes; else `components`
  bool normalized = false;
  const std::uint8_t* data = nullptr;
  struct Sparse {
    std::uint64_t count = 0, indexBytes = 1;
    const std::uint8_t* indices = nullptr;
    const std::uint8_t* values = nullptr;
  } sparse;
};

/// Bytes from one element of a packed accessor to the next.
std::uint64_t elementBytes(const GltfAccessor& accessor);
/// The components of the element at `at`, normalised integers as in glTF 2.0, 3.6.2.2.
void readElement(const GltfAccessor& accessor, const std::uint8_t* at, float* components);
/// Reads a little-endian unsigned integer of 1, 2 or 4 bytes.
std::uint32_t unsignedFrom(const std::uint8_t* at, std::uint64_t bytes);

/// All components of all elements, element after element, sparse substitution done; normalised integers as in
/// glTF 2.0, 3.6.2.2.
std::vector<float> contentsOf(const GltfAccessor& accessor);

/// Calls visit(index, components) for every element, without the memory of contentsOf. Elements that sparse
/// substitution replaces are visited too.
template <class Visit>
void forEachElement(const GltfAccessor& a, Visit&& visit) {
  float values[16];
  const auto show = [&](std::uint64_t i, const std::uint8_t* at) {
    readElement(a, at, values);
    visit(i, static_cast<const float*>(values));
  };
  if (a.data)
    for (std::uint64_t i = 0; i < a.count; ++i) show(i, a.data + i * a.stride);
  for (std::uint64_t i = 0; i < a.sparse.count; ++i)
    show(unsignedFrom(a.sparse.indices + i * a.sparse.indexBytes, a.sparse.indexBytes),
         a.sparse.values + i * elementBytes(a));
}

}  // namespace saccade::core
