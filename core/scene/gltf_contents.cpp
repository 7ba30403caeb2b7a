#include "core/scene/gltf_contents.h"

#include <algorithm>
#include <cstring>

namespace saccade::core {
namespace {

template <class T>
float scaled(const std::uint8_t* at, bool normalized, float largest) {
  T value;
  std::memcpy(&value, at, sizeof value);
  const float x = static_cast<float>(value);
  return normalized ? std::max(x / largest, -1.0f) : x;
}

float componentAt(const std::uint8_t* at, const GltfAccessor& a) {
  switch (a.componentType) {
    case 5120:
      return scaled<std::int8_t>(at, a.normalized, 127);
    case 5121:
      return scaled<std::uint8_t>(at, a.normalized, 255);
    case 5122:
      return scaled<std::int16_t>(at, a.normalized, 32767);
    case 5123:
      return scaled<std::uint16_t>(at, a.normalized, 65535);
    case 5125:
      return scaled<std::uint32_t>(at, false, 1);
    default:
      return scaled<float>(at, false, 1);
  }
}

}  // namespace

std::uint64_t elementBytes(const GltfAccessor& a) {
  const std::uint64_t bytes = gltfComponentBytes(a.componentType), column = a.rows * bytes;
  if (a.rows == a.components) return column;
  return (column + 3) / 4 * 4 * (a.components / a.rows);
}

void readElement(const GltfAccessor& a, const std::uint8_t* at, float* components) {
  const std::uint64_t bytes = gltfComponentBytes(a.componentType);
  const std::uint64_t column = a.rows == a.components ? 0 : elementBytes(a) / (a.components / a.rows);
  for (std::uint64_t c = 0; c < a.components; ++c)
    components[c] = componentAt(at + c / a.rows * column + c % a.rows * bytes, a);
}

std::vector<float> contentsOf(const GltfAccessor& a) {
  std::vector<float> out(a.count * a.components, 0.0f);
  forEachElement(a, [&](std::uint64_t i, const float* components) {
    std::copy_n(components, a.components, out.begin() + static_cast<std::ptrdiff_t>(i * a.components));
  });
  return out;
}

std::uint32_t unsignedFrom(const std::uint8_t* at, std::uint64_t bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, at, bytes);
  return value;
}

}  // namespace saccade::core
