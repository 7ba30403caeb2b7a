// What density estimation sums over: windows of texels, and rings of vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "raytrace/bake/density.h"

namespace saccade::raytrace {

/// Window half sides in texels or edges, the growing sequence that is tried.
inline constexpr std::array<int, 15> kRadii = {0, 1, 2, 3, 4, 6, 8, 11, 16, 22, 32, 45, 64, 90, 128};
/// Sums within fewer effective particles than this have no usable error of their own.
inline constexpr double kFew = 6;

/// What a window holds. Weights are in mean particles.
struct WindowSum {
  glm::dvec3 weight{0};
  double squared = 0;  ///< of luminance weights
  double area = 0;     ///< m^2

  WindowSum& operator+=(const WindowSum& o) {
    weight += o.weight;
    squared += o.squared;
    area += o.area;
    return *this;
  }
  double luminance() const { return 0.2126 * weight.x + 0.7152 * weight.y + 0.0722 * weight.z; }
  double effectiveCount() const { return squared > 0 ? luminance() * luminance() / squared : 0; }
};

/// Grows while its estimate agrees with those of all smaller windows.
class WindowRule {
 public:
  explicit WindowRule(const DensityOptions& options) : options_(options) {}

  /// The next wider window; false when it is not to be taken.
  bool takes(const WindowSum& sum) {
    const double mean = sum.luminance() / sum.area;
    // Few or no particles do not pass for certainty.
    const double error = options_.confidence * std::sqrt(sum.squared + options_.doubt) / sum.area;
    if (mean - error > high_ || mean + error < low_) return false;
    low_ = std::max(low_, mean - error);
    high_ = std::min(high_, mean + error);
    return true;
  }
  bool suffices(const WindowSum& sum) const { return sum.effectiveCount() >= options_.enough; }

 private:
  const DensityOptions& options_;
  double low_ = 0, high_ = core::kInfinity;
};

/// A plane through the densities of a window's parts by least squares, weighted by a bell over the window:
/// its value at the centre. Where the window is cut at a chart's border, or light rises across it, the mean
/// would be off by the slope times the way to the window's centroid (local linear regression, Fan 1992).
class LocalPlane {
 public:
  /// `at`: middle of the part, from the window's centre, in half sides.
  void add(const WindowSum& part, const glm::dvec2& at) {
    const double bell = (kBellReach - at.x * at.x) * (kBellReach - at.y * at.y);
    const glm::dvec3 basis(1, at.x, at.y);
    normal_ += glm::outerProduct(basis, basis) * (bell * part.area);
    for (int c = 0; c < 3; ++c) moments_[c] += basis * (bell * part.weight[c]);
  }
  /// Weight per area at the centre, no less than a fraction of `mean` and no more than a multiple: noise.
  glm::dvec3 center(const glm::dvec3& mean) const {
    const double scale = normal_[0][0];
    const glm::dmat3 m = normal_ / scale;
    if (!(glm::determinant(m) > kSmallestDeterminant)) return mean;
    const glm::dvec3 row = glm::inverse(m)[0];  // symmetric
    glm::dvec3 value;
    for (int c = 0; c < 3; ++c) value[c] = glm::dot(row, moments_[c]) / scale;
    return glm::clamp(value, mean / kLargestChange, mean * kLargestChange);
  }

 private:
  static constexpr double kBellReach = 1.2;  // half sides: not quite 0 at the window's edge
  static constexpr double kSmallestDeterminant = 1e-4;
  static constexpr double kLargestChange = 3;
  glm::dmat3 normal_{0};
  glm::dvec3 moments_[3] = {};
};

/// Of a window with that density (weight per area).
inline DensityEstimate estimateOf(const WindowSum& whole, const glm::dvec3& density, double watts) {
  DensityEstimate out;
  out.irradiance = Vec3(density * watts);
  if (whole.luminance() > 0)
    out.relativeError = static_cast<float>(std::sqrt(whole.squared) / whole.luminance());
  return out;
}

}  // namespace saccade::raytrace
