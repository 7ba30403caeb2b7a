// Four numbers side by side: the same arithmetic for the rays of one rough lobe. Each lane has the bits that
// the same expression has in a float, for nothing is contracted.
#pragma once

#include <immintrin.h>

#include "core/math/types.h"

namespace saccade::raytrace {

using Lanes = float __attribute__((vector_size(16)));
inline constexpr int kLanes = 4;

inline Lanes squareRoot(Lanes x) { return _mm_sqrt_ps(x); }
/// As std::clamp: NaN stays.
inline Lanes clampLanes(Lanes x, float low, float high) {
  const Lanes least = Lanes{} + low, most = Lanes{} + high;
  return x < least ? least : x > most ? most : x;
}
inline Lanes atLeast(Lanes x, float low) {
  const Lanes least = Lanes{} + low;
  return x < least ? least : x;
}

struct Vec3Lanes {
  Lanes x, y, z;
  core::Vec3 operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
};
inline Lanes dot(const Vec3Lanes& a, const Vec3Lanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes dot(const Vec3Lanes& a, const core::Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3Lanes operator*(const Vec3Lanes& v, Lanes s) { return {v.x * s, v.y * s, v.z * s}; }
inline Vec3Lanes normalize(const Vec3Lanes& v) { return v * (1.0f / squareRoot(dot(v, v))); }

}  // namespace saccade::raytrace
