// What fills closed transmitters: Beer-Lambert's law along the path, KHR_materials_volume.
#pragma once

#include <array>
#include <cstdint>

#include "core/scene/scene.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// The solids that a path is in, innermost last. Solids that overlap are taken as nested in the order of
/// entry; beyond kDeepest they are not entered.
class Inside {
 public:
  static constexpr int kDeepest = 4;

  /// Brings the state to that of a ray that leaves `surface` along `direction`, on either side of it.
  void leave(const Surface& surface, const Vec3& direction);
  /// What is left of light over the last `distance` metres before a hit on `object`. A back face of a solid
  /// is met from within that solid, also where no entry was seen (camera inside glass).
  Vec3 transmittance(const World& world, std::uint32_t object, bool front, float distance) const;
  /// The same of a ray that meets nothing on its way.
  Vec3 transmittance(const World& world, float distance) const;

 private:
  std::array<std::uint32_t, kDeepest> objects_{};
  int count_ = 0;
};

}  // namespace saccade::raytrace
