// Random numbers keyed by (pixel, sub-sample, dimension, seed): not by level, thread or region, so that a
// pixel's value does not depend on who traces it when.
#pragma once

#include <cstdint>

#include "core/math/types.h"

namespace saccade::core {

/// Avalanching 64 -> 32 bit mix of its arguments.
std::uint32_t hashKey(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

/// One pixel's one sub-sample. Successive calls take successive dimensions. Over the sub-samples of one pixel
/// each (pair of) dimension is an Owen-scrambled (0, 2)-sequence, shuffled between dimensions: padded, as in
/// Burley 2020.
class PixelSampler {
 public:
  PixelSampler(std::uint32_t x, std::uint32_t y, std::uint64_t subSample, std::uint32_t seed);
  float next1D();  ///< [0, 1)
  Vec2 next2D();   ///< [0, 1)^2

 private:
  std::uint32_t pixelKey_;
  std::uint32_t index_;
  std::uint32_t dimension_ = 0;
};

}  // namespace saccade::core
