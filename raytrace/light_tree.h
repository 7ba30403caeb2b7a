// Choosing one of many lamps: A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting", Proc. ACM Comput. Graph. Interact. Tech. 1(2), 2018.
//
// Departures: no splitting (one lamp a sample, so that the cost is that of one descent); the receiver's
// normal does not enter (a choice serves a whole point, whatever its lobes); and a split whose smaller side
// holds less than an eighth of the lamps is replaced by one in the middle, so that the depth is at most 1 +
// log(n) / log(8 / 7), whatever their places.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::raytrace {

using core::Vec3;

/// One lamp, or a bound of several: where they are, where they shine, how much.
struct LightBounds {
  core::Bounds box;
  Vec3 axis{0, 1, 0};          ///< unit, of the cone of normals
  float spread = 0;            ///< its half angle, radians, [0, pi]
  float emission = core::kPi;  ///< light leaves within this angle of a normal: pi / 2 for surfaces
  float power = 0;             ///< pi times the radiant intensity along the normal, W, > 0

  /// The smallest bound of both that has the form.
  LightBounds unite(const LightBounds& other) const;
};

/// Read-only once built: any thread may draw.
class LightTree {
 public:
  LightTree() = default;
  /// Lamps of finite boxes and finite positive power; they are named by their index.
  explicit LightTree(std::span<const LightBounds> lamps);

  bool empty() const { return nodes_.empty(); }
  /// Steps from the root to the deepest lamp.
  int depth() const { return depth_; }

  struct Drawn {
    std::uint32_t lamp = 0;
    float probability = 0;  ///< > 0
  };
  /// u in [0, 1). False where no lamp can reach the point.
  bool draw(const Vec3& point, float u, Drawn& out) const;
  /// With which draw() takes this lamp; 0 for one that cannot reach the point. Sums to 1 over the lamps.
  float probability(const Vec3& point, std::uint32_t lamp) const;
  /// Estimated irradiance at the point from all lamps, W/m^2, blockers left out.
  float irradiance(const Vec3& point) const;

 private:
  struct Node {
    Vec3 center{0};
    float radius = 0;  ///< around the box
    Vec3 axis{0, 1, 0};
    float power = 0;
    float cosSpread = 1, sinSpread = 0;
    float cosEmission = -1;
    std::uint32_t parent = 0;
    std::uint32_t second = 0;  ///< the second child; the first follows its parent. 0: a lamp
    std::uint32_t lamp = 0;
  };
  std::uint32_t build(std::span<const LightBounds> lamps, std::span<std::uint32_t> part, std::uint32_t parent,
                      int depth);
  float importance(const Node& node, const Vec3& point) const;

  std::vector<Node> nodes_;            ///< [0] is the root
  std::vector<std::uint32_t> leafOf_;  ///< by lamp
  int depth_ = 0;
};

}  // namespace saccade::raytrace
