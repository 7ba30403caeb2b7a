#include "raytrace/bake/duplicates.h"

#include <algorithm>
#include <numeric>

namespace saccade::raytrace {
namespace {

bool before(const Vec3& a, const Vec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// A triangle's corners in the order of their positions.
struct Key {
  std::uint32_t space;
  std::array<Vec3, 3> position;
  std::array<std::uint8_t, 3> corner{0, 1, 2};
  std::uint32_t triangle;

  Key(const TriangleShape& shape, std::uint32_t t) : space(shape.space), triangle(t) {
    std::sort(corner.begin(), corner.end(),
              [&](std::uint8_t a, std::uint8_t b) { return before(shape.position[a], shape.position[b]); });
    for (int k = 0; k < 3; ++k) position[k] = shape.position[corner[k]];
  }
  bool operator<(const Key& o) const {
    if (space != o.space) return space < o.space;
    for (int k = 0; k < 3; ++k) {
      if (position[k] != o.position[k]) return before(position[k], o.position[k]);
    }
    return triangle < o.triangle;
  }
};

/// Whether the permutation turns the triangle over.
bool isOdd(const std::array<std::uint8_t, 3>& p) { return (p[1] + 3 - p[0]) % 3 == 2; }

}  // namespace

Duplicates::Duplicates(const World& world) {
  std::vector<Key> keys;
  keys.reserve(world.triangleCount());
  for (std::uint32_t t = 0; t < world.triangleCount(); ++t) keys.emplace_back(world.shape(t), t);
  std::sort(keys.begin(), keys.end());
  for (std::size_t first = 0, i = 1; i < keys.size(); ++i) {
    if (keys[i].space != keys[first].space || keys[i].position != keys[first].position) {
      first = i;
      continue;
    }
    Duplicate d;
    d.original = keys[first].triangle;
    d.triangle = keys[i].triangle;
    for (int k = 0; k < 3; ++k) d.corner[keys[first].corner[k]] = keys[i].corner[k];
    d.flipped = isOdd(d.corner);
    all_.push_back(d);
  }
  std::stable_sort(all_.begin(), all_.end(),
                   [](const Duplicate& a, const Duplicate& b) { return a.original < b.original; });
}

std::span<const Duplicate> Duplicates::of(std::uint32_t original) const {
  if (all_.empty()) return {};
  const auto low = std::lower_bound(all_.begin(), all_.end(), original,
                                    [](const Duplicate& d, std::uint32_t t) { return d.original < t; });
  auto high = low;
  while (high != all_.end() && high->original == original) ++high;
  return {low, high};
}

}  // namespace saccade::raytrace
