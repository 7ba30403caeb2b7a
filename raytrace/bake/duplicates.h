// Triangles that lie on others: files hold faces twice, and rays meet only the first of equal triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/world.h"

namespace saccade::raytrace {

/// A triangle with the same three corners as an earlier one of the same space (TriangleShape::space).
struct Duplicate {
  std::uint32_t original = 0, triangle = 0;
  std::array<std::uint8_t, 3> corner{};  ///< corner k of the original is corner[k] of the duplicate
  bool flipped = false;                  ///< wound the other way: its front is the original's back
};

/// Built once per bake; read by any thread.
class Duplicates {
 public:
  explicit Duplicates(const World& world);
  std::span<const Duplicate> of(std::uint32_t original) const;

 private:
  std::vector<Duplicate> all_;  ///< by original
};

}  // namespace saccade::raytrace
