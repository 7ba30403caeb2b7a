// Light from an environment map, importance sampled: by luminance times solid angle over the cells of the
// picture, uniform in solid angle within a cell. Pharr, Jakob, Humphreys, "Physically Based Rendering", 3rd
// edition, section 14.2.4, with two departures:
// - the radiance is interpolated between texels, so a black texel beside a bright one is not black: a cell's
//   weight is the mean of the interpolated luminance over it (exactly so but for the curvature of the sphere
//   within a cell), and its density is positive wherever light is;
// - uniform in the cosine of the colatitude, not in the colatitude: no sine to divide by at the poles.
#pragma once

#include <cmath>
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
  /// Integral of the luminance over all directions: the mean irradiance over all orientations times 4.
  double total() const { return total_; }
  Vec3 radiance(const Vec3& direction) const { return core::environmentRadiance(*environment_, direction); }
  /// u in [0, 1)^2. Only where it shines.
  EnvironmentSample sample(const Vec2& u) const;
  /// Density of sample() per solid angle; direction of any length but 0. The integral over the sphere is 1.
  float pdf(const Vec3& direction) const;

 private:
  /// Of the columns of a row, cumulative; the last is 1.
  const float* row(int y) const { return &columns_[static_cast<std::size_t>(y) * width_]; }
  float density(int x, int y) const;
  double solidAngle(int y) const {  ///< of one cell
    return 2 * M_PI / width_ * (cosines_[y] - cosines_[y + 1]);
  }

  std::shared_ptr<const core::Environment> environment_;
  int width_ = 0, height_ = 0;
  std::vector<float> rows_;      ///< cumulative, the last is 1
  std::vector<float> columns_;   ///< row by row
  std::vector<double> cosines_;  ///< of the colatitudes that part the rows, from 1 down to -1
  double total_ = 0;
};

}  // namespace saccade::raytrace
