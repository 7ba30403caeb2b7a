// The vector types of the whole program, and axis-aligned bounds.
// Conventions: metres, right-handed, Y up; colour is linear Rec. 709 radiance.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace saccade::core {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Relative luminance of linear Rec. 709.
inline float luminance(const Vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// An axis-aligned box; empty until something is added.
struct Bounds {
  Vec3 lo{kInfinity};
  Vec3 hi{-kInfinity};

  void add(const Vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  void add(const Bounds& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
  bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
  Vec3 center() const { return 0.5f * (lo + hi); }
  Vec3 extent() const { return empty() ? Vec3(0) : hi - lo; }
  float diagonal() const { return glm::length(extent()); }
  bool contains(const Vec3& p) const {
    return glm::all(glm::lessThanEqual(lo, p)) && glm::all(glm::lessThanEqual(p, hi));
  }
};

}  // namespace saccade::core
