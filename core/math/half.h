// IEEE 754 half floats, by the F16C instructions that the whole program is compiled for.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace saccade::core {

/// Rounds to nearest even; beyond 65504 gives infinity, NaN stays NaN.
inline std::uint16_t toHalf(float x) {
  return static_cast<std::uint16_t>(_cvtss_sh(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
}
/// Exact.
inline float fromHalf(std::uint16_t h) { return _cvtsh_ss(h); }

}  // namespace saccade::core
