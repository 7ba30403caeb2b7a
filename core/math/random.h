// Random numbers keyed by (pixel, sub-sample, dimension, seed): not by level, thread or region, so that a
// pixel's value does not depend on who traces it when.
//
// Brent Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020, with the permutation constants that
// Nathan Vegdahl found for it ("Building a Better LK Hash", 2021). Departure: the second Sobol dimension is
// not summed over direction vectors. Its generator is the Pascal matrix modulo 2, a Kronecker power of
// (1 1; 0 1), which five masked shifts apply to all 32 bits at once. All is inline: it runs some ten times a
// ray.
#pragma once

#include <cstdint>

#include "core/math/types.h"

namespace saccade::core {

/// Avalanching 64 -> 32 bit mix of its arguments.
std::uint32_t hashKey(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

namespace detail {

/// A bijection of 64-bit words in which every input bit reaches every output bit (David Stafford's variant 13
/// of the MurmurHash3 finaliser).
inline std::uint64_t mix64(std::uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ull;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebull;
  return v ^ (v >> 31);
}

/// Four 32-bit words side by side. Below, Word is this or std::uint32_t.
using WordLanes = std::uint32_t __attribute__((vector_size(16)));

template <class Word>
Word reverseBits(Word v) {
  v = (v >> 16) | (v << 16);
  v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  return ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
}

/// Owen scrambling of a number whose most significant digit is bit 0: a bit is flipped by a hash of the bits
/// below it.
template <class Word>
Word scrambleReversed(Word v, Word key) {
  v ^= v * 0x3d20adeau;
  v += key;
  v *= (key >> 16) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

/// The second Sobol dimension of an index, most significant digit at bit 0: digit i is the sum modulo 2 of
/// the index bits j with binomial(j, i) odd, that is (Lucas) with i a bitwise subset of j.
template <class Word>
Word sobolSecondReversed(Word index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

/// The upper 24 bits as a float in [0, 1): exact, never rounded up to 1.
inline float toUnitFloat(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace detail

/// One pixel's one sub-sample. Successive calls take successive dimensions. Over the sub-samples of one pixel
/// each (pair of) dimension is an Owen-scrambled (0, 2)-sequence, shuffled between dimensions: padded, as in
/// Burley 2020. Every 2^32 sub-samples start a sequence of their own.
class PixelSampler {
 public:
  PixelSampler(std::uint32_t x, std::uint32_t y, std::uint64_t subSample, std::uint32_t seed)
      : pixelKey_(detail::mix64(detail::mix64(std::uint64_t{y} << 32 | x) ^
                                (std::uint64_t{seed} << 32 | (subSample >> 32)))),
        reversedIndex_(detail::reverseBits(static_cast<std::uint32_t>(subSample))) {}

  float next1D() {  ///< [0, 1)
    const std::uint64_t keys = nextKeys();
    return first(shuffledIndex(keys), keys);
  }
  Vec2 next2D() {  ///< [0, 1)^2
    const std::uint64_t keys = nextKeys();
    const std::uint32_t index = shuffledIndex(keys);
    const std::uint32_t second =
        detail::scrambleReversed(detail::sobolSecondReversed(index), secondKey(keys));
    return {first(index, keys), detail::toUnitFloat(detail::reverseBits(second))};
  }
  /// What four calls of next2D() return, side by side; but only `count` of them count as taken.
  void next2D(Vec2 (&out)[4], int count) {
    detail::WordLanes shuffle, low, high;
    for (int k = 0; k < 4; ++k) {
      const std::uint64_t keys = keysOf(dimension_ + 1 + static_cast<std::uint32_t>(k));
      shuffle[k] = static_cast<std::uint32_t>(keys);
      low[k] = static_cast<std::uint32_t>(keys >> 32);
      high[k] = secondKey(keys);
    }
    dimension_ += static_cast<std::uint32_t>(count);
    const detail::WordLanes index =
        detail::reverseBits(detail::scrambleReversed(detail::WordLanes{} + reversedIndex_, shuffle));
    const detail::WordLanes first = detail::reverseBits(detail::scrambleReversed(index, low));
    const detail::WordLanes second =
        detail::reverseBits(detail::scrambleReversed(detail::sobolSecondReversed(index), high));
    for (int k = 0; k < 4; ++k) out[k] = {detail::toUnitFloat(first[k]), detail::toUnitFloat(second[k])};
  }

 private:
  std::uint64_t keysOf(std::uint32_t dimension) const {
    return detail::mix64(pixelKey_ + 0x9e3779b97f4a7c15ull * std::uint64_t{dimension});
  }
  static std::uint32_t secondKey(std::uint64_t keys) {
    return static_cast<std::uint32_t>((keys * 0xd1342543de82ef95ull) >> 32);
  }
  std::uint64_t nextKeys() { return keysOf(++dimension_); }
  /// Shuffling by Owen scrambling keeps aligned blocks of 2^k indices together, hence the stratification.
  std::uint32_t shuffledIndex(std::uint64_t keys) const {
    return detail::reverseBits(detail::scrambleReversed(reversedIndex_, static_cast<std::uint32_t>(keys)));
  }
  /// The first Sobol dimension is the reversed index, so the reversal before the scrambling cancels.
  static float first(std::uint32_t index, std::uint64_t keys) {
    const auto key = static_cast<std::uint32_t>(keys >> 32);
    return detail::toUnitFloat(detail::reverseBits(detail::scrambleReversed(index, key)));
  }

  std::uint64_t pixelKey_;
  std::uint32_t reversedIndex_;
  std::uint32_t dimension_ = 0;
};

}  // namespace saccade::core
