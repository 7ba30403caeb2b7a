// Scattering at a surface point.
//
//   metallic-roughness (glTF 2.0, appendix B) with KHR_materials_transmission, _ior, _specular:
//     S   GGX reflection, height-correlated Smith, Schlick's Fresnel
//     D   Lambert layered under it as core/scene/specular_albedo.h says
//     G   dielectric with exact Fresnel: GGX reflection and refraction (Walter et al. 2007); a closed object
//     is a
//         solid, any other a thin sheet whose two sides are summed: R = 2F / (1 + F)
//   mixed as metallic S(baseColor) + (1 - metallic) [(1 - transmission) (S + D) + transmission G].
// Visible normals are sampled (Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023). Below
// kDeltaAlpha S and G are mirrors. Refraction carries no eta^2: camera and light paths both begin and end
// outside solids, where the factors cancel, so one function serves radiance and photons.
#pragma once

#include <optional>

#include "raytrace/surface.h"

namespace saccade::raytrace {

/// Perceptual roughness squared; below this a lobe is a delta.
inline constexpr float kDeltaAlpha = 1e-3f;

enum Lobes : unsigned { kLobeDiffuse = 1, kLobeSpecular = 2, kLobeAll = 3 };

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

/// Unpolarised Fresnel reflectance of a dielectric. cosI in [0, 1], eta = n_t / n_i > 0; 1 beyond the
/// critical angle.
float fresnelDielectric(float cosI, float eta);

/// GGX density of facet normals, alpha > 0, h unit in the local frame (x and y carry the precision near the
/// pole).
float ggxD(const Vec3& h, float alpha);
/// Smith's Lambda.
float ggxLambda(float cosV, float alpha);
/// Visible normal for a view direction in the local frame, v.z > 0.
Vec3 sampleVisibleNormal(const Vec3& v, float alpha, const Vec2& u);

/// An orthonormal basis around a unit normal (Duff et al. 2017); sound at n = (0, 0, -1).
struct Frame {
  Vec3 t, b, n;
  explicit Frame(const Vec3& normal);
  Vec3 toLocal(const Vec3& w) const { return {glm::dot(w, t), glm::dot(w, b), glm::dot(w, n)}; }
  Vec3 toWorld(const Vec3& w) const { return w.x * t + w.y * b + w.z * n; }
};

/// The material at one point seen from one direction. A value; keeps no reference to the surface's memory.
class Bsdf {
 public:
  /// `toEye`: unit, from the surface to where the path came from.
  Bsdf(const Surface& surface, const Vec3& toEye, DiffuseModel diffuse = DiffuseModel::lambert);

  /// The specular lobes are deltas.
  bool delta() const { return delta_; }
  float alpha() const { return alpha_; }  ///< GGX
  bool hasSpecular() const { return specularAny_; }
  bool hasDiffuse() const { return diffuseAny_; }
  bool transmits() const { return glass_ > 0; }

  /// f(toEye, wi) |cos wi| without deltas; wi unit. 0 across the surface where nothing transmits.
  Vec3 eval(const Vec3& wi, unsigned lobes) const;
  /// Density of sample() per solid angle, deltas left out.
  float pdf(const Vec3& wi, unsigned lobes) const;
  /// Nothing when the direction carries no light. uLobe chooses lobes, u the direction; all in [0, 1).
  std::optional<BsdfSample> sample(float uLobe, const Vec2& u, unsigned lobes) const;

  /// For deltas: both branches with their whole weights (no probability).
  BsdfSample deltaReflection() const;
  std::optional<BsdfSample> deltaTransmission() const;

  /// View-dependent Lambert under an irradiance map: baseColor ... (1 - E(v)) / pi, times irradiance =
  /// radiance (exact for constant illumination; core/scene/specular_albedo.h).
  Vec3 diffuseUnderMap() const;

 private:
  struct Interface {
    Vec3 reflect;   ///< reflectance of the facet, S and G together
    Vec3 transmit;  ///< transmittance of the facet
  };
  Interface facet(float cosVH) const;
  float reflectProbability(const Interface& f) const;
  float diffuseProbability(unsigned lobes) const;
  Vec3 evalSpecular(const Vec3& wi) const;
  float pdfSpecular(const Vec3& wi) const;
  Vec3 evalDiffuse(const Vec3& wi) const;
  std::optional<BsdfSample> sampleSpecular(float uLobe, const Vec2& u) const;
  Vec3 refract(const Vec3& h, float cosVH) const;
  bool sideAgrees(const Vec3& wiWorld, const Vec3& wiLocal) const;

  Frame frame_;
  Vec3 ng_;
  Vec3 v_;               ///< toEye, local
  float alpha_ = 1;      ///< GGX
  float roughness_ = 1;  ///< perceptual
  float eta_ = 1;        ///< n_t / n_i for light going the way of -toEye
  float mirror_ = 1;     ///< weight of S
  float glass_ = 0;      ///< weight of G
  float lambert_ = 0;    ///< weight of D
  Vec3 f0_{0};           ///< of S, metal and dielectric mixed
  Vec3 f0Dielectric_{0};
  float f90_ = 1, f90Dielectric_ = 1;
  Vec3 baseColor_{0};
  float lambdaV_ = 0;
  DiffuseModel diffuseModel_ = DiffuseModel::lambert;
  float diffuseShare_ = 0;  ///< probability of D when all lobes are sampled
  bool thin_ = false, straight_ = false, delta_ = false, specularAny_ = false, diffuseAny_ = false;
};

}  // namespace saccade::raytrace
