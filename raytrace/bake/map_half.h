// Irradiance as illumination maps store it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/half.h"

namespace saccade::raytrace {

inline constexpr float kLargestHalf = 65504;

/// No NaN, nothing negative, nothing infinite.
inline std::uint16_t mapHalf(float value) {
  return core::toHalf(std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, kLargestHalf));
}

}  // namespace saccade::raytrace
