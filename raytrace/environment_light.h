// Light from an environment map, importance sampled in proportion to luminance times solid angle.
//
// The radiance is interpolated between texels: a sum of tents, one around each texel's centre. So a texel is
// drawn by its luminance times its row's solid angle (its row first, then its column), and a place under its
// tent. The density is then the interpolation of those weights, as cheap to look up as the radiance, and the
// quotient of the two is constant but for the change of the sine from row to row: no noise from within a sun
// of one texel, none from constant skies.
#pragma once

#include <memory>
#include <vector>

#include "core/scene/environment.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

struct EnvironmentSample {
  Vec3 direction{0, 1, 0};  ///< unit, towards the light
  Vec3 radiance{0};
  float pdf = 0;  ///< per solid angle
};

/// Read-only once built: any thread may call.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(std::shared_ptr<const core::Environment> environment);

  /// It is not black.
  bool shines() const { return total_ > 0; }
  /// Integral of the luminance over all directions (as if each texel were constant): 4 times the mean
  /// irradiance over all orientations.
  double total() const { return total_; }
  Vec3 radiance(const Vec3& direction) const { return core::environmentRadiance(*environment_, direction); }
  /// u in [0, 1)^2. Only where it shines.
  EnvironmentSample sample(const Vec2& u) const;
  /// Density of sample() per solid angle; direction of any length but 0. The integral over the sphere is 1.
  float pdf(const Vec3& direction) const { return density(core::environmentUv(*environment_, direction)); }

 private:
  float density(const Vec2& uv) const;

  std::shared_ptr<const core::Environment> environment_;
  int width_ = 0, height_ = 0;
  std::vector<float> rows_;        ///< cumulative, the last is 1
  std::vector<float> columns_;     ///< the same of each row's columns, row by row
  std::vector<float> solidAngle_;  ///< of a row's texels
  float perUv_ = 0;                ///< weight to density per picture area, over the sphere's 2 pi^2
  double total_ = 0;
};

}  // namespace saccade::raytrace
