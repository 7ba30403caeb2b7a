// Linear radiance to 8-bit sRGB without a power function: exactly round(255 * encodeSrgb(linear)).
#pragma once

#include <immintrin.h>

#include <array>
#include <bit>
#include <cstdint>

namespace saccade::core {

/// The 255 steps of round(255 * encodeSrgb(x)) lie more than 1/256 of x apart at the top of each octave and
/// more than 1/128 at its bottom, so each of 128 equal parts of an octave holds at most one. An entry is
/// (code below the step) * 65536 + (65536 - place of the step in the part): adding the low half of the
/// float's bits carries into the code where x has passed the step.
class Srgb8 {
 public:
  /// Clamps to [0, 1] first; NaN and negative give 0, +infinity 255.
  std::uint8_t operator()(float linear) const {
    const float atLeast = linear > kFirst ? linear : kFirst;
    const auto bits = std::bit_cast<std::uint32_t>(atLeast < kLast ? atLeast : kLast);
    return static_cast<std::uint8_t>((parts_[(bits >> 16) - kFirstPart] + (bits & 0xffffu)) >> 16);
  }
  /// Eight values at once, in the low byte of each lane.
  __m256i encode8(__m256 linear) const {
    // maxps gives its second operand for NaN.
    const __m256 inside = _mm256_min_ps(_mm256_max_ps(linear, _mm256_set1_ps(kFirst)), _mm256_set1_ps(kLast));
    const __m256i bits = _mm256_castps_si256(inside);
    const __m256i part =
        _mm256_sub_epi32(_mm256_srli_epi32(bits, 16), _mm256_set1_epi32(static_cast<int>(kFirstPart)));
    const __m256i entry = _mm256_i32gather_epi32(reinterpret_cast<const int*>(parts_.data()), part, 4);
    const __m256i place = _mm256_and_si256(bits, _mm256_set1_epi32(0xffff));
    return _mm256_srli_epi32(_mm256_add_epi32(entry, place), 16);
  }
  /// The one table; built on first use, any thread.
  static const Srgb8& table();

 private:
  Srgb8();

  static constexpr float kFirst = 0x1p-13f;       ///< below the first step, 0.5 / 255 / 12.92
  static constexpr float kLast = 0x1.fffffep-1f;  ///< largest float below 1
  static constexpr std::uint32_t kFirstPart = std::bit_cast<std::uint32_t>(kFirst) >> 16;
  static constexpr std::uint32_t kParts = 13 * 128;
  std::array<std::uint32_t, kParts> parts_;
};

}  // namespace saccade::core
