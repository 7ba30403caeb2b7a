#include "core/srgb8.h"

#include <cmath>

#include "core/image_io.h"

namespace saccade::core {
namespace {

std::uint32_t codeOfBits(std::uint32_t floatBits) {
  return static_cast<std::uint32_t>(std::floor(255.0f * encodeSrgb(std::bit_cast<float>(floatBits)) + 0.5f));
}

}  // namespace

// In double precision before the last rounding, so that the encoded value never falls as the linear one
// rises.
float encodeSrgb(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  const double x = linear;
  return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

float decodeSrgb(float encoded) {
  if (!(encoded > 0)) return 0;
  if (encoded >= 1) return 1;
  const double x = encoded;
  return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

Srgb8::Srgb8() {
  for (std::uint32_t part = 0; part < kParts; ++part) {
    const std::uint32_t first = (kFirstPart + part) << 16;
    const std::uint32_t code = codeOfBits(first);
    // Bisection for the first place in the part where the code is the next one; 65536 when there is none.
    std::uint32_t low = 0, high = 65536;
    while (low < high) {
      const std::uint32_t middle = (low + high) / 2;
      if (codeOfBits(first + middle) > code) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    parts_[part] = code * 65536 + (65536 - low);
  }
}

const Srgb8& Srgb8::table() {
  static const Srgb8 table;
  return table;
}

}  // namespace saccade::core
