#include "raytrace/duplicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace saccade::raytrace {

std::vector<bool> findDuplicates(std::span<const TriangleShape> shapes) {
  using Corner = std::array<float, 3>;
  struct Key {
    std::uint32_t space;
    std::array<Corner, 3> corners;
    std::uint32_t triangle;
    bool operator<(const Key& o) const {
      return std::tie(space, corners, triangle) < std::tie(o.space, o.corners, o.triangle);
    }
  };
  std::vector<Key> keys;
  keys.reserve(shapes.size());
  for (std::uint32_t t = 0; t < shapes.size(); ++t) {
    Key key;
    key.space = shapes[t].space;
    key.triangle = t;
    bool finite = true;  // NaN has no order; Embree leaves such triangles out
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = shapes[t].position[k];
      key.corners[k] = {p.x, p.y, p.z};
      finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    }
    if (!finite) continue;
    std::sort(key.corners.begin(), key.corners.end());
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> duplicate(shapes.size());
  for (std::size_t i = 1; i < keys.size(); ++i) {
    duplicate[keys[i].triangle] =
        keys[i].space == keys[i - 1].space && keys[i].corners == keys[i - 1].corners;
  }
  return duplicate;
}

}  // namespace saccade::raytrace
