// Scattering at a surface point.
//
//   metallic-roughness (glTF 2.0, appendix B) with KHR_materials_transmission, _ior, _specular, _anisotropy:
//     S   GGX reflection, height-correlated Smith, Schlick's Fresnel
//     D   Lambert layered under it as core/scene/specular_albedo.h says
//     G   dielectric with exact Fresnel: GGX reflection and refraction (Walter et al. 2007); a closed object
//     is a
//         solid, any other a thin sheet whose two sides are summed: R = 2F / (1 + F)
//   mixed as metallic S(baseColor) + (1 - metallic) [(1 - transmission) (S + D) + transmission G];
//   or Ward's lobe over Lambert (ward.h);
//   under KHR_materials_sheen and over that _clearcoat (layers.h).
// Visible normals are sampled (Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023). Below
// kDeltaAlpha S, G and the coat are mirrors. Refraction carries no eta^2: camera and light paths both begin
// and end outside solids, where the factors cancel, so one function serves radiance and photons.
#pragma once

#include <optional>

#include "raytrace/base_lobe.h"
#include "raytrace/layers.h"
#include "raytrace/microfacet.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {

enum Lobes : unsigned {
  kLobeDiffuse = 1,
  kLobeBase = 2,  ///< S and G, or Ward
  kLobeSheen = 4,
  kLobeCoat = 8,
  kLobeSpecular = kLobeBase | kLobeSheen | kLobeCoat,
  kLobeAll = kLobeDiffuse | kLobeSpecular
};

/// What lies under the specular lobe.
enum class DiffuseModel {
  lambert,  ///< glTF, the maps and the base layer
  burley    ///< Lambert times Burley's retro-reflection (2012, section 5.3), as Blender's Principled BSDF has
            ///< it: to compare pictures with such renderers
};

struct BsdfSample {
  Vec3 direction{0};  ///< unit, away from the surface
  Vec3 weight{0};     ///< f |cos| / pdf (delta: reflectance / probability)
  float pdf = 0;      ///< per solid angle; 0 for a delta
  bool delta = false;
  bool transmitted = false;
};

/// Four of them, none transmitted or delta.
struct BsdfLanes {
  Vec3Lanes direction, weight;
  Lanes pdf;
  Lanes side;  ///< nothing was drawn unless > 0
};

/// The material at one point seen from one direction. A value; keeps no reference to the surface's memory.
class Bsdf {
 public:
  /// `toEye`: unit, from the surface to where the path came from.
  Bsdf(const Surface& surface, const Vec3& toEye, DiffuseModel diffuse = DiffuseModel::lambert);

  /// The base's specular lobes are deltas.
  bool delta() const { return base_.delta(); }
  bool hasSpecular() const { return base_.any(); }
  bool hasDiffuse() const { return diffuseAny_; }
  bool transmits() const { return base_.transmits(); }
  /// Sheen or a coat lies over the base.
  bool layered() const { return layered_; }
  /// The lobes beyond Lambert that are no deltas.
  unsigned roughLobes() const;
  /// Of the widest rough lobe: GGX or Ward, 1 for sheen.
  float alpha() const;
  /// About what the lobes reflect and transmit of light towards the eye, luminance; deltas counted.
  float estimate(unsigned lobes) const;
  /// Probability with which sample() with kLobeAll draws the diffuse lobe.
  float diffuseChance() const;

  /// From now on the index that one channel of light sees: Surface::iorOf.
  void setIor(float ior) { base_.setIor(ior); }

  /// f(toEye, wi) |cos wi| without deltas; wi unit. 0 across the surface where nothing transmits.
  Vec3 eval(const Vec3& wi, unsigned lobes) const;
  /// Density of sample() per solid angle, deltas left out.
  float pdf(const Vec3& wi, unsigned lobes) const;
  /// Nothing when the direction carries no light. uLobe chooses lobes, u the direction; all in [0, 1).
  std::optional<BsdfSample> sample(float uLobe, const Vec2& u, unsigned lobes) const;

  /// Only GGX reflection lies over the Lambert lobe: sampleLanes() may be called.
  bool plain() const { return !layered_ && base_.plain(); }
  /// sample() of four points at once, kLobeBase alone.
  BsdfLanes sampleLanes(const Vec2 (&u)[kLanes]) const;

  /// For deltas: the base's branches with their whole weights (no probability).
  BsdfSample deltaReflection() const;
  std::optional<BsdfSample> deltaTransmission() const;
  /// The mirror of a smooth coat; nothing for a rough one or none.
  std::optional<BsdfSample> coatReflection() const;

  /// View-dependent Lambert under an irradiance map: baseColor ... (1 - E(v)) / pi, times irradiance =
  /// radiance (exact for constant illumination; core/scene/specular_albedo.h).
  Vec3 diffuseUnderMap() const;

 private:
  void addLayers(const Surface& surface, const ExtensionPoint& extension);
  float diffuseProbability(unsigned lobes) const;
  Vec3 evalDiffuse(const Vec3& l) const;
  core::OverLambert overLambert() const;
  float attenuation(const Vec3& l) const;
  float coatAttenuation(const Vec3& l) const;
  Vec3 evalLayered(const Vec3& wi, const Vec3& l, unsigned lobes) const;
  float pdfLayered(const Vec3& wi, const Vec3& l, unsigned lobes) const;
  std::optional<BsdfSample> sampleLayered(float uLobe, const Vec2& u, unsigned lobes) const;
  static Vec3 sampleCosine(const Vec2& u);
  BsdfSample toWorld(const LocalSample& local) const {
    return {glm::normalize(frame_.toWorld(local.direction)), local.weight, local.pdf, local.delta,
            local.transmitted};
  }
  bool sideAgrees(const Vec3& wiWorld, const Vec3& wiLocal) const;

  Frame frame_;
  Vec3 ng_;
  Vec3 v_;  ///< toEye, local
  BaseLobe base_;
  float roughness_ = 1;  ///< perceptual; of the lobe over Lambert
  Vec3 baseColor_{0};
  DiffuseModel diffuseModel_ = DiffuseModel::lambert;
  float diffuseShare_ = 0;  ///< probability of D when all lobes are sampled and nothing lies over them
  bool diffuseAny_ = false, layered_ = false;
  bool within_ = false;  ///< seen from inside a solid: the layers lie behind the surface
  std::optional<Sheen> sheen_;
  std::optional<Coat> coat_;
  float estimates_[4] = {};  ///< by lobe, in the order of Lobes; only when layered
};

}  // namespace saccade::raytrace
