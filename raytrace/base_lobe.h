// What a material reflects and transmits by its own surface, layers apart: metallic-roughness reflection S,
// the dielectric interface G (see bsdf.h), or Ward's lobe. Directions are local: z is the shading normal, v
// the way to the eye.
#pragma once

#include <optional>

#include "core/scene/specular_albedo.h"
#include "raytrace/lanes.h"
#include "raytrace/microfacet.h"
#include "raytrace/surface.h"
#include "raytrace/ward.h"

namespace saccade::raytrace {

/// A direction drawn in the local frame.
struct LocalSample {
  Vec3 direction{0};
  Vec3 weight{0};
  float pdf = 0;  ///< per solid angle; 0 for a delta
  bool delta = false;
  bool transmitted = false;
};

/// Four of them, none transmitted or delta. Nothing where direction.z <= 0.
struct LocalLanes {
  Vec3Lanes direction, weight;
  Lanes pdf;
};

class BaseLobe {
 public:
  /// Reflects nothing.
  BaseLobe() = default;
  /// `v`: local, v.z > 0.
  BaseLobe(const Surface& surface, const Vec3& v);

  bool any() const { return any_; }
  bool delta() const { return delta_; }
  bool transmits() const { return glass_ > 0; }
  bool thin() const { return thin_; }
  float alpha() const { return ggx_.widest(); }
  float lambert() const { return lambert_; }  ///< weight of the Lambert lobe beside this one
  const Vec3& f0Dielectric() const { return f0Dielectric_; }
  float f90Dielectric() const { return f90Dielectric_; }
  /// About what it reflects and transmits, for choosing lobes: S as the albedo table has it, all of G.
  float estimate(const core::AlbedoPair& pair) const;
  /// The index that light of one channel sees (solids; no effect on the others).
  void setIor(float ior);

  /// f |l.z| without deltas.
  Vec3 eval(const Vec3& l) const;
  float pdf(const Vec3& l) const;
  std::optional<LocalSample> sample(float uLobe, const Vec2& u) const;
  /// GGX reflection and nothing else: sampleLanes() may be called.
  bool plain() const { return plain_; }
  /// sample() of four points at once.
  LocalLanes sampleLanes(const Vec2 (&u)[kLanes]) const;
  /// For deltas: both branches with their whole weights.
  LocalSample mirror() const;
  std::optional<LocalSample> refraction() const;

 private:
  struct Interface {
    Vec3 reflect;   ///< reflectance of the facet, S and G together
    Vec3 transmit;  ///< transmittance of the facet
  };
  /// The facet that sends v into the solid along l, and the density's change of variables.
  struct Crossing {
    Vec3 h{0};
    float vh = 0, jacobian = 0;
  };
  void addFilm(const core::ThinFilm& film);
  Interface facet(float cosVH) const;
  Vec3 filmedMirror(float cosVH) const;
  Vec3 filmedGlass(float cosVH, float plain) const;
  float reflectProbability(const Interface& f) const;
  bool crossing(const Vec3& l, Crossing& c) const;
  Vec3 refract(const Vec3& h, float cosVH) const;
  std::optional<LocalSample> sampleWard(const Vec2& u) const;

  Vec3 v_{0, 0, 1};
  Ggx ggx_;
  float lambdaV_ = 0;
  float eta_ = 1;         ///< n_t / n_i for light going the way of -v
  float mirror_ = 0;      ///< weight of S
  float glass_ = 0;       ///< weight of G
  float lambert_ = 0;     ///< weight of D
  Vec3 f0_{0};            ///< of S, metal and dielectric mixed
  Vec3 f0Dielectric_{0};  ///< of the lobe over Lambert; with a film, its bound (core::filmedF0)
  Vec3 f0Estimate_{0};    ///< the same of f0_
  float f90_ = 1, f90Dielectric_ = 1;
  Vec3 baseColor_{0};
  core::ThinFilm film_;
  Vec3 underFilm_{0};  ///< the dielectric's F0
  std::optional<Ward> ward_;
  bool entering_ = true, thin_ = false, straight_ = false, delta_ = false, any_ = false, plain_ = false;
};

}  // namespace saccade::raytrace
