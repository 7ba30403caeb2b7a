// What lies over a material's base: sheen, and a clearcoat over both. Each attenuates what is below by
// min(T(v), T(l)), T = 1 - albedo: reciprocal, and as bright as the extensions' own forms for the darker of
// the two directions. Directions are local to the base's frame.
#pragma once

#include "core/scene/specular_albedo.h"
#include "raytrace/base_lobe.h"

namespace saccade::raytrace {

/// KHR_materials_clearcoat: GGX of index 1.5 with its own roughness and normal.
/// Departure: the extension lets 1 - coat F(v.n) through, v alone; here min over both directions of
/// 1 - coat E, with E the rough coat's albedo.
class Coat {
 public:
  Coat(float weight, float roughness, const Vec3& normal, const Vec3& v);

  bool delta() const { return delta_; }
  float alpha() const { return alpha_; }
  float weight() const { return weight_; }
  float roughness() const { return roughness_; }
  float estimate() const { return 1 - passedV_; }  ///< albedo seen from v
  /// T towards the eye and towards l.
  float passedV() const { return passedV_; }
  float passed(const Vec3& l) const;
  float cosine(const Vec3& l) const;  ///< against the coat's normal, on either side, [0, 1]

  Vec3 eval(const Vec3& l) const;  ///< f cos against the coat's normal, no deltas
  float pdf(const Vec3& l) const;
  std::optional<LocalSample> sample(const Vec2& u) const;
  LocalSample mirror() const;

 private:
  float reflectance(float cosVH) const;
  Frame frame_;
  Vec3 v_;  ///< in frame_
  float weight_, roughness_, alpha_, lambdaV_ = 0, passedV_ = 1;
  bool delta_;
};

/// KHR_materials_sheen; see core/scene/sheen.h.
class Sheen {
 public:
  Sheen(const Vec3& color, float roughness, const Vec3& v);

  float weight() const { return largest_; }  ///< largest channel of the colour
  float roughness() const { return roughness_; }
  float estimate() const { return core::luminance(color_) / largest_ * (1 - passedV_); }
  float passedV() const { return passedV_; }
  float passed(const Vec3& l) const;

  Vec3 eval(const Vec3& l) const;  ///< f cos
  /// Uniform over the hemisphere.
  float pdf(const Vec3& l) const { return l.z > 0 ? 1 / (2 * core::kPi) : 0; }
  std::optional<LocalSample> sample(const Vec2& u) const;

 private:
  Vec3 v_, color_;
  float roughness_, largest_, passedV_;
};

}  // namespace saccade::raytrace
