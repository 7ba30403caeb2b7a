#include "raytrace/medium.h"

#include <algorithm>

namespace saccade::raytrace {

void Inside::leave(const Surface& surface, const Vec3& direction) {
  if (!surface.closed || !(surface.material->transmission > 0)) return;
  const auto end = objects_.begin() + count_, at = std::find(objects_.begin(), end, surface.object);
  if (at != end) {
    std::move(at + 1, end, at);
    --count_;
  }
  const bool across = glm::dot(direction, surface.ng) < 0;
  if (across == surface.front && count_ < kDeepest) objects_[count_++] = surface.object;
}

Vec3 Inside::transmittance(const World& world, std::uint32_t object, bool front, float distance) const {
  if (!front && world.solid(object)) return beerLambert(world.materialOf(object).absorption, distance);
  return transmittance(world, distance);
}

Vec3 Inside::transmittance(const World& world, float distance) const {
  if (count_ == 0) return Vec3(1);
  return beerLambert(world.materialOf(objects_[count_ - 1]).absorption, distance);
}

}  // namespace saccade::raytrace
