#include "raytrace/bake/gutters.h"

#include <algorithm>
#include <vector>

namespace saccade::raytrace {
namespace {

constexpr int kRings = 2;

/// One ring of texels around what is filled; they count as filled afterwards.
void growRing(int size, std::span<core::Vec3> irradiance, std::vector<char>& filled) {
  const auto index = [size](int x, int y) { return static_cast<std::size_t>(y) * size + x; };
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < size && y < size && filled[index(x, y)] != 0;
  };
  std::vector<std::size_t> ring;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      if (filled[index(x, y)]) continue;
      core::Vec3 sum(0);
      int count = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (!inside(x + dx, y + dy)) continue;
          const core::Vec3 nearest = irradiance[index(x + dx, y + dy)];
          core::Vec3 value = nearest;
          if (inside(x + 2 * dx, y + 2 * dy)) {
            value = glm::clamp(2.0f * nearest - irradiance[index(x + 2 * dx, y + 2 * dy)], 0.5f * nearest,
                               2.0f * nearest);
          }
          sum += value;
          ++count;
        }
      }
      if (count == 0) continue;
      irradiance[index(x, y)] = sum / static_cast<float>(count);
      ring.push_back(index(x, y));
    }
  }
  for (const std::size_t i : ring) filled[i] = 1;
}

}  // namespace

void fillGutters(const TexelMap& texels, std::span<core::Vec3> irradiance) {
  std::vector<char> filled(texels.texelCount());
  for (std::size_t i = 0; i < filled.size(); ++i) {
    filled[i] = texels.chartOf(i) >= 0 && texels.area(i) > 0;
    if (!filled[i]) irradiance[i] = core::Vec3(0);
  }
  for (int ring = 0; ring < kRings; ++ring) growRing(texels.size(), irradiance, filled);
}

}  // namespace saccade::raytrace
