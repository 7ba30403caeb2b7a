// Repeatable randomness for pictures and placement.
#pragma once

#include <cstdint>

#include "core/math/types.h"

namespace saccade::data {

/// Avalanching mix of three integers to [0, 1).
float hash01(std::uint32_t a, std::uint32_t b, std::uint32_t c);

/// Smooth noise in [0, 1] that repeats every `period` cells in x and y (0 = never).
float valueNoise(core::Vec2 p, int period, std::uint32_t seed);

/// Sum of octaves, each twice as fine and half as strong, in [0, 1]; `period` is that of the first octave.
float fbm(core::Vec2 p, int octaves, int period, std::uint32_t seed);

/// Cellular noise: distance to the nearest and to the second nearest feature point, in cells; repeats.
struct Cells {
  float nearest = 0, second = 0;
  std::uint32_t id = 0;  ///< of the nearest point
};
Cells cellular(core::Vec2 p, int period, std::uint32_t seed);

}  // namespace saccade::data
