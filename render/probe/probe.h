// A light probe: what the base layer shows around one point, and how far away it is; six pictures of 90
// degrees drawn by the base renderer itself. Nothing is traced, so that a replay makes the same probes.
//
// Distances make one probe serve a whole object: a ray from elsewhere is followed to where it meets what the
// probe sees ("distance impostors", Szirmay-Kalos, Aszodi, Lazanyi, Premecz, Approximate Ray-Tracing on the
// GPU with Distance Impostors, Eurographics 2005). What the probe's point does not see is guessed.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/math/types.h"
#include "core/scene/scene.h"
#include "render/base/base_renderer.h"

namespace saccade::render {

class Probe {
 public:
  static constexpr int kSide = 64;  ///< texels along a face

  /// GL thread. Draws the scene without the objects whose entry in `hidden` is not 0 (by object; empty =
  /// none). Throws as BaseRenderer::render.
  Probe(BaseRenderer& renderer, const core::Scene& scene, const core::Vec3& center,
        std::span<const char> hidden);

  /// Radiance that arrives at `origin` from the unit vector `direction`: mean over a cone of `spread` radians
  /// across; 0 = a mirror's. Any thread.
  core::Vec3 radiance(const core::Vec3& origin, const core::Vec3& direction, float spread) const;

 private:
  static constexpr int kDistances = kSide / 2;  ///< along a face
  static constexpr int kLevels = 7;             ///< kSide down to 1
  static_assert(kSide == 1 << (kLevels - 1));

  /// Where a direction points to: a face, and [0, 1]^2 on it.
  struct Place {
    int face;
    core::Vec2 at;
  };
  static Place placeOf(const core::Vec3& direction);
  void drawFace(int face, BaseRenderer& renderer, const core::Scene& scene, std::span<const char> hidden);
  void halve(int face, int level);
  float distance(const core::Vec3& direction) const;
  core::Vec3 texel(const Place& place, int level) const;

  core::Vec3 center_;
  std::array<std::vector<core::Vec4>, kLevels> levels_;  ///< radiance, w = 0; a face after the other
  /// From the centre, along the texels' centres; infinite where nothing is. Apart and coarser, so that a
  /// look-up finds them in the nearest cache.
  std::vector<float> distances_;
};

}  // namespace saccade::render
