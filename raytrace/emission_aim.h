// Aimed emission: particles that are to meet mirrors and glass, for caustics. H. W. Jensen aims photons by
// projection maps ("Global Illumination using Photon Maps", EGWR 1996); here the map is the set of the
// objects' bounding spheres, and a one-sample mixture with the balance heuristic (Veach 1997, section 9.2.4)
// keeps every light path possible, so that the mean is that of plain emission whatever the aim.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "raytrace/lanes.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

class World;

/// Half of the particles start towards the bounding spheres of the scene's specular objects, with a density
/// in proportion to the weights of the spheres that hold the direction: to each sphere a share by its weight
/// times its solid angle. Read-only once built: any thread may call.
class EmissionAim {
 public:
  /// Beyond these only the largest targets are aimed at; the rest is left to plain emission.
  static constexpr std::size_t kMostTargets = 64;

  struct Target {
    Vec3 center{0};    ///< world
    float radius = 0;  ///< metres, > 0
    float weight = 0;  ///< > 0: density of the aim within its cone, relative to other targets'
  };

  /// One target for each object that has a lobe besides Lambert's; its weight: what part of its light leaves
  /// by such lobes, how sharply, and how much of its sphere the object fills.
  explicit EmissionAim(const World& world);
  explicit EmissionAim(std::vector<Target> targets);

  /// Random numbers in [0, 1): one that chooses plain or aimed emission, and those of what is aimed.
  struct Chance {
    float mix = 0, target = 0;
    Vec2 place{0};  ///< on the target as it is seen
  };

  /// From a point: may replace the plainly drawn unit `direction`. `density(direction)`: of plain emission,
  /// per solid angle. `normal`: of a flat emitter, which shines into its half space alone, or 0. Returns what
  /// the plain flux in that direction is to be multiplied with: in [0, 2].
  template <class Density>
  float fromPoint(const Vec3& origin, const Vec3& normal, const Chance& chance, const Density& density,
                  Vec3& direction) const {
    Cones cones;
    if (!see(origin, normal, cones)) return 1;
    if (chance.mix < kAimed) direction = drawDirection(cones, chance);
    return share(density(direction), densityOf(cones, direction));
  }

  /// Parallel light along the unit `direction`: may replace the plainly drawn point `origin`, by another of
  /// the same plane across the direction. `density(origin)`: of plain emission, per m^2 of that plane.
  template <class Density>
  float fromAfar(const Vec3& direction, const Chance& chance, const Density& density, Vec3& origin) const {
    if (targets_.empty()) return 1;
    if (chance.mix < kAimed) origin = drawOrigin(direction, origin, chance);
    return share(density(origin), densityOf(origin, direction));
  }

 private:
  static constexpr float kAimed = 0.5f;  ///< of the particles

  /// Four targets side by side; of the last four some may be empty: weight 0.
  struct Quad {
    Vec3Lanes center;
    Lanes radius, weight;
  };
  /// The targets as a point sees them, by quad.
  struct Cones {
    Vec3 origin{0};
    std::array<Lanes, kMostTargets / kLanes> reach;  ///< dot(direction, way to the centre) >= it in the cone
    std::array<Lanes, kMostTargets / kLanes> size;   ///< weight times solid angle
    std::array<float, kMostTargets / kLanes> cumulative;  ///< of sizes, to the quad's last
    float total() const { return cumulative[quads - 1]; }
    std::size_t quads = 0;
  };

  static float share(float plain, float aimed) {
    return plain > 0 ? plain / ((1 - kAimed) * plain + kAimed * aimed) : 0;
  }
  bool see(const Vec3& origin, const Vec3& normal, Cones& cones) const;
  Vec3 drawDirection(const Cones& cones, const Chance& chance) const;
  float densityOf(const Cones& cones, const Vec3& direction) const;
  Vec3 drawOrigin(const Vec3& direction, const Vec3& plain, const Chance& chance) const;
  float densityOf(const Vec3& origin, const Vec3& direction) const;

  std::vector<Target> targets_;
  std::vector<Quad> quads_;
  std::vector<float> discs_;  ///< cumulative weight times area of the targets' silhouettes
};

}  // namespace saccade::raytrace
