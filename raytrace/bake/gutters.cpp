#include "raytrace/bake/gutters.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace saccade::raytrace {
namespace {

constexpr int kRings = 2;

constexpr double kWhole = 0.999;  // share of a texel that counts as all of it

/// Fits a plane to the texels of one chart around a texel.
class Slope {
 public:
  void add(const Plane2& place, double weight, const core::Vec3& value) {
    weight_ += weight;
    place_ += weight * place;
    value_ += weight * glm::dvec3(value);
    square_ += weight * glm::dmat2(place * place.x, place * place.y);
    product_[0] += weight * place.x * glm::dvec3(value);
    product_[1] += weight * place.y * glm::dvec3(value);
  }
  /// What the plane changes over `way`; along directions that the texels do not span it is level.
  core::Vec3 along(const Plane2& way) const {
    if (!(weight_ > 0)) return core::Vec3(0);
    constexpr double kLevel = 1e-2;
    const Plane2 centre = place_ / weight_;
    glm::dmat2 spread = square_ / weight_ - glm::dmat2(centre * centre.x, centre * centre.y);
    spread[0][0] += kLevel;
    spread[1][1] += kLevel;
    const Plane2 w = glm::inverse(spread) * way;
    const glm::dvec3 x = product_[0] / weight_ - centre.x * value_ / weight_,
                     y = product_[1] / weight_ - centre.y * value_ / weight_;
    return core::Vec3(w.x * x + w.y * y);
  }

 private:
  double weight_ = 0;
  Plane2 place_{0};
  glm::dvec3 value_{0};
  glm::dmat2 square_{0};
  glm::dvec3 product_[2] = {glm::dvec3(0), glm::dvec3(0)};
};

/// Texels that a chart's border cuts.
std::unordered_map<std::size_t, TexelCover> partialTexels(const TexelMap& texels,
                                                          const std::vector<char>& filled) {
  std::unordered_map<std::size_t, TexelCover> out;
  const int size = texels.size();
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (!filled[i] || texels.charts()[static_cast<std::size_t>(texels.chartOf(i))].byVertex) continue;
    const int x = static_cast<int>(i % static_cast<std::size_t>(size)),
              y = static_cast<int>(i / static_cast<std::size_t>(size));
    bool border = x == 0 || y == 0 || x + 1 == size || y + 1 == size;
    for (const std::ptrdiff_t step : {-1, 1, -size, size})
      border = border || texels.chartOf(i + static_cast<std::size_t>(step)) != texels.chartOf(i);
    if (!border) continue;
    const TexelCover cover = texels.coverOf(i);
    if (cover.share < kWhole) out.emplace(i, cover);
  }
  return out;
}

/// A texel holds the mean over what it covers; look-ups take it for the light at its centre. Moves the values
/// of texels that a border cuts there, along the slope of the chart's light around them.
void moveToCentres(const TexelMap& texels, const std::vector<char>& filled,
                   std::span<core::Vec3> irradiance) {
  constexpr int kReach = 2;
  const int size = texels.size();
  const std::unordered_map<std::size_t, TexelCover> partial = partialTexels(texels, filled);
  std::vector<std::pair<std::size_t, core::Vec3>> moved;
  for (const auto& [texel, cover] : partial) {
    const int x = static_cast<int>(texel % static_cast<std::size_t>(size)),
              y = static_cast<int>(texel / static_cast<std::size_t>(size));
    const Plane2 centre(x + 0.5, y + 0.5);
    Slope slope;
    for (int ny = std::max(y - kReach, 0); ny <= std::min(y + kReach, size - 1); ++ny) {
      for (int nx = std::max(x - kReach, 0); nx <= std::min(x + kReach, size - 1); ++nx) {
        const std::size_t i = static_cast<std::size_t>(ny) * static_cast<std::size_t>(size) + nx;
        if (!filled[i] || texels.chartOf(i) != texels.chartOf(texel)) continue;
        const auto found = partial.find(i);
        const Plane2 place = found == partial.end() ? Plane2(nx + 0.5, ny + 0.5) : found->second.centroid;
        slope.add(place - centre, found == partial.end() ? 1 : found->second.share, irradiance[i]);
      }
    }
    const core::Vec3 value = irradiance[texel];
    moved.emplace_back(texel,
                       glm::clamp(value + slope.along(centre - cover.centroid), 0.5f * value, 2.0f * value));
  }
  for (const auto& [texel, value] : moved) irradiance[texel] = value;
}

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
  moveToCentres(texels, filled, irradiance);
  for (int ring = 0; ring < kRings; ++ring) growRing(texels.size(), irradiance, filled);
}

}  // namespace saccade::raytrace
