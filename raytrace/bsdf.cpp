#include "raytrace/bsdf.h"

#include <algorithm>
#include <cmath>

#include "core/scene/specular_albedo.h"

namespace saccade::raytrace {
namespace {

/// Below this difference from 1, an index bends nothing: rough refraction would be a delta anyway.
constexpr float kSameIndex = 1e-3f;
constexpr float kLowestCosine = 1e-6f;

/// E = F0 a + F90 b by channel, at most 1.
Vec3 albedoOf(const core::AlbedoPair& pair, const Vec3& f0, float f90) {
  return glm::min(f0 * pair.scale + Vec3(f90 * pair.bias), Vec3(1));
}

/// What Burley's diffuse reflects, over Lambert; directions local.
float burleyFactor(const Vec3& v, const Vec3& l, float roughness) {
  const Vec3 sum = v + l;
  const float length = glm::length(sum);
  const float cosHalf = length > 0 ? glm::dot(l, sum) / length : 0;
  const float grazing = 2 * roughness * cosHalf * cosHalf - 0.5f;  // F_D90 - 1
  const auto side = [&](float cosine) {
    const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
    return 1 + grazing * (m * m * m * m * m);
  };
  return side(v.z) * side(l.z);
}

Vec3 schlick(const Vec3& f0, float f90, float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
  const float m2 = m * m;
  return f0 + (Vec3(f90) - f0) * (m2 * m2 * m);
}

float largest(const Vec3& c) { return std::max({c.x, c.y, c.z}); }

}  // namespace

float fresnelDielectric(float cosI, float eta) {
  const float c = std::clamp(cosI, 0.0f, 1.0f);
  const float g2 = eta * eta - 1 + c * c;
  if (!(g2 > 0)) return 1;
  const float g = std::sqrt(g2);
  // Rs and Rp with g = eta cos_t: no division by a vanishing sine.
  const float s = (c - g) / (c + g);
  const float p = (eta * eta * c - g) / (eta * eta * c + g);
  return std::min(0.5f * (s * s + p * p), 1.0f);
}

float ggxD(const Vec3& h, float alpha) {
  const float a2 = alpha * alpha;
  const float d = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
  return a2 / (core::kPi * d * d);
}

float ggxLambda(float cosV, float alpha) {
  const float c2 = std::max(cosV * cosV, 1e-12f);
  return 0.5f * (std::sqrt(1 + alpha * alpha * std::max(0.0f, 1 - c2) / c2) - 1);
}

Vec3 sampleVisibleNormal(const Vec3& v, float alpha, const Vec2& u) {
  const Vec3 stretched = glm::normalize(Vec3(alpha * v.x, alpha * v.y, v.z));
  // A direction in the cap of mirror directions that the hemisphere allows; its half vector is the normal.
  const float phi = 2 * core::kPi * u.y;
  const float z = (1 - u.x) * (1 + stretched.z) - stretched.z;
  const float s = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
  const Vec3 h(s * std::cos(phi) + stretched.x, s * std::sin(phi) + stretched.y, z + stretched.z);
  return glm::normalize(Vec3(alpha * h.x, alpha * h.y, std::max(h.z, kLowestCosine)));
}

Frame::Frame(const Vec3& normal) : n(normal) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1 / (sign + n.z);
  const float c = n.x * n.y * a;
  t = {1 + sign * n.x * n.x * a, sign * c, -sign * n.x};
  b = {c, sign + n.y * n.y * a, -n.y};
}

Bsdf::Bsdf(const Surface& surface, const Vec3& toEye, DiffuseModel diffuseModel)
    : frame_(surface.ns), ng_(surface.ng), diffuseModel_(diffuseModel) {
  v_ = frame_.toLocal(toEye);
  v_.z = std::max(v_.z, kLowestCosine);
  if (!surface.scatters()) return;
  const MaterialPoint& m = surface.point;
  baseColor_ = m.baseColor;
  roughness_ = m.roughness;
  alpha_ = m.roughness * m.roughness;
  delta_ = alpha_ < kDeltaAlpha;
  thin_ = !surface.closed;
  eta_ = surface.front || thin_ ? m.ior : 1 / m.ior;
  straight_ = !thin_ && std::fabs(eta_ - 1) < kSameIndex;
  glass_ = (1 - m.metallic) * m.transmission;
  mirror_ = 1 - glass_;
  lambert_ = (1 - m.metallic) * (1 - m.transmission);
  f0Dielectric_ = m.dielectricF0;
  f90Dielectric_ = m.dielectricF90;
  if (mirror_ > 0) {
    f0_ = (m.baseColor * m.metallic + m.dielectricF0 * lambert_) / mirror_;
    f90_ = (m.metallic + m.dielectricF90 * lambert_) / mirror_;
  }
  specularAny_ = true;
  diffuseAny_ = lambert_ > 0 && largest(baseColor_) > 0;
  lambdaV_ = delta_ ? 0 : ggxLambda(v_.z, alpha_);
  if (!diffuseAny_) return;
  const core::AlbedoPair pair = core::directionalAlbedo(v_.z, roughness_);
  const float specular = core::luminance(albedoOf(pair, f0_, f90_)) * mirror_ + glass_;
  const float diffuse =
      core::luminance(baseColor_ * (Vec3(1) - albedoOf(pair, f0Dielectric_, f90Dielectric_))) * lambert_;
  diffuseShare_ = diffuse > 0 ? diffuse / (diffuse + specular) : 0;
}

Bsdf::Interface Bsdf::facet(float cosVH) const {
  Interface f{Vec3(0), Vec3(0)};
  if (mirror_ > 0) f.reflect = schlick(f0_, f90_, cosVH) * mirror_;
  if (glass_ > 0) {
    float r = fresnelDielectric(cosVH, eta_);
    if (thin_) r = 2 * r / (1 + r);
    f.reflect += Vec3(glass_ * r);
    f.transmit = baseColor_ * (glass_ * (1 - r));
  }
  return f;
}

float Bsdf::reflectProbability(const Interface& f) const {
  const float reflect = core::luminance(f.reflect), transmit = core::luminance(f.transmit);
  return transmit > 0 ? reflect / (reflect + transmit) : 1;
}

float Bsdf::diffuseProbability(unsigned lobes) const {
  if (!diffuseAny_ || !(lobes & kLobeDiffuse)) return 0;
  return lobes & kLobeSpecular ? diffuseShare_ : 1;
}

bool Bsdf::sideAgrees(const Vec3& wiWorld, const Vec3& wiLocal) const {
  return wiLocal.z * glm::dot(wiWorld, ng_) > 0;
}

Vec3 Bsdf::evalDiffuse(const Vec3& wi) const {
  if (!diffuseAny_ || wi.z <= 0) return Vec3(0);
  const Vec3 ev = albedoOf(core::directionalAlbedo(v_.z, roughness_), f0Dielectric_, f90Dielectric_);
  const Vec3 el = albedoOf(core::directionalAlbedo(wi.z, roughness_), f0Dielectric_, f90Dielectric_);
  const Vec3 mean = albedoOf(core::meanAlbedo(roughness_), f0Dielectric_, f90Dielectric_);
  const Vec3 room = glm::max(Vec3(1) - mean, Vec3(1e-4f));
  const float retro = diffuseModel_ == DiffuseModel::burley ? burleyFactor(v_, wi, roughness_) : 1.0f;
  return baseColor_ * (lambert_ / core::kPi * wi.z * retro) * (Vec3(1) - ev) * (Vec3(1) - el) / room;
}

Vec3 Bsdf::diffuseUnderMap() const {
  if (!diffuseAny_) return Vec3(0);
  const Vec3 ev = albedoOf(core::directionalAlbedo(v_.z, roughness_), f0Dielectric_, f90Dielectric_);
  return baseColor_ * (Vec3(1) - ev) * (lambert_ / core::kPi);
}

Vec3 Bsdf::evalSpecular(const Vec3& wi) const {
  if (!specularAny_ || delta_) return Vec3(0);
  if (wi.z > 0 || thin_) {
    const Vec3 up(wi.x, wi.y, std::fabs(wi.z));
    const Vec3 h = glm::normalize(v_ + up);
    const Interface f = facet(glm::dot(v_, h));
    const float g2 = 1 / (1 + lambdaV_ + ggxLambda(up.z, alpha_));
    return (wi.z > 0 ? f.reflect : f.transmit) * (ggxD(h, alpha_) * g2 / (4 * v_.z));
  }
  if (glass_ <= 0 || straight_) return Vec3(0);
  Vec3 h = -(v_ + eta_ * wi);
  if (h.z < 0) h = -h;
  const float length = glm::length(h);
  if (!(length > 0)) return Vec3(0);
  h /= length;
  const float vh = glm::dot(v_, h), lh = glm::dot(wi, h);
  if (vh <= 0 || lh >= 0) return Vec3(0);
  const float jacobian = eta_ * eta_ * -lh / ((vh + eta_ * lh) * (vh + eta_ * lh));
  const float g2 = 1 / ((1 + lambdaV_) * (1 + ggxLambda(-wi.z, alpha_)));
  return facet(vh).transmit * (ggxD(h, alpha_) * g2 * vh / v_.z * jacobian);
}

float Bsdf::pdfSpecular(const Vec3& wi) const {
  if (!specularAny_ || delta_) return 0;
  const float g1 = 1 / (1 + lambdaV_);
  if (wi.z > 0 || thin_) {
    const Vec3 h = glm::normalize(v_ + Vec3(wi.x, wi.y, std::fabs(wi.z)));
    const float reflect = reflectProbability(facet(glm::dot(v_, h)));
    return ggxD(h, alpha_) * g1 / (4 * v_.z) * (wi.z > 0 ? reflect : 1 - reflect);
  }
  if (glass_ <= 0 || straight_) return 0;
  Vec3 h = -(v_ + eta_ * wi);
  if (h.z < 0) h = -h;
  const float length = glm::length(h);
  if (!(length > 0)) return 0;
  h /= length;
  const float vh = glm::dot(v_, h), lh = glm::dot(wi, h);
  if (vh <= 0 || lh >= 0) return 0;
  const float jacobian = eta_ * eta_ * -lh / ((vh + eta_ * lh) * (vh + eta_ * lh));
  return ggxD(h, alpha_) * g1 * vh / v_.z * jacobian * (1 - reflectProbability(facet(vh)));
}

Vec3 Bsdf::eval(const Vec3& wi, unsigned lobes) const {
  const Vec3 local = frame_.toLocal(wi);
  if (local.z == 0 || !sideAgrees(wi, local)) return Vec3(0);
  Vec3 f(0);
  if (lobes & kLobeDiffuse) f += evalDiffuse(local);
  if (lobes & kLobeSpecular) f += evalSpecular(local);
  return f;
}

float Bsdf::pdf(const Vec3& wi, unsigned lobes) const {
  const Vec3 local = frame_.toLocal(wi);
  if (local.z == 0 || !sideAgrees(wi, local)) return 0;
  const float diffuse = diffuseProbability(lobes);
  float p = diffuse > 0 && local.z > 0 ? diffuse * local.z / core::kPi : 0;
  if ((lobes & kLobeSpecular) && diffuse < 1) p += (1 - diffuse) * pdfSpecular(local);
  return p;
}

Vec3 Bsdf::refract(const Vec3& h, float cosVH) const {
  const float sine2 = std::max(0.0f, 1 - cosVH * cosVH) / (eta_ * eta_);
  const float cosT = std::sqrt(std::max(0.0f, 1 - sine2));
  return (cosVH / eta_ - cosT) * h - v_ / eta_;
}

std::optional<BsdfSample> Bsdf::sampleSpecular(float uLobe, const Vec2& u) const {
  const Vec3 h = delta_ ? Vec3(0, 0, 1) : sampleVisibleNormal(v_, alpha_, u);
  const float vh = std::clamp(glm::dot(v_, h), 0.0f, 1.0f);
  const Interface f = facet(vh);
  const float chance = reflectProbability(f);
  const bool reflected = uLobe < chance;
  Vec3 l = 2 * vh * h - v_;
  BsdfSample s;
  s.transmitted = !reflected;
  s.delta = delta_;
  float shadowing = 1;  // G2 / G1(v)
  if (reflected || thin_) {
    if (l.z <= 0) return std::nullopt;
    if (!delta_) {
      shadowing = (1 + lambdaV_) / (1 + lambdaV_ + ggxLambda(l.z, alpha_));
      s.pdf = ggxD(h, alpha_) / ((1 + lambdaV_) * 4 * v_.z) * (reflected ? chance : 1 - chance);
    }
    if (!reflected) l = delta_ ? -v_ : Vec3(l.x, l.y, -l.z);
  } else if (straight_) {
    l = -v_;
    s.delta = true;
  } else {
    l = refract(h, vh);
    if (l.z >= 0) return std::nullopt;
    if (!delta_) {
      const float lh = glm::dot(l, h), denominator = vh + eta_ * lh;
      shadowing = 1 / (1 + ggxLambda(-l.z, alpha_));
      s.pdf = ggxD(h, alpha_) * vh * eta_ * eta_ * std::fabs(lh) * (1 - chance) /
              ((1 + lambdaV_) * v_.z * denominator * denominator);
    }
  }
  s.weight = (reflected ? f.reflect / chance : f.transmit / (1 - chance)) * shadowing;
  s.direction = glm::normalize(frame_.toWorld(l));
  if (!sideAgrees(s.direction, l)) return std::nullopt;
  return s;
}

std::optional<BsdfSample> Bsdf::sample(float uLobe, const Vec2& u, unsigned lobes) const {
  const float diffuse = diffuseProbability(lobes);
  if (uLobe < diffuse) {
    const float r = std::sqrt(u.x), phi = 2 * core::kPi * u.y;
    const Vec3 l(r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u.x)));
    BsdfSample s;
    s.direction = glm::normalize(frame_.toWorld(l));
    s.pdf = pdf(s.direction, lobes);
    if (!(s.pdf > 0) || l.z <= 0) return std::nullopt;
    s.weight = eval(s.direction, lobes) / s.pdf;
    return s;
  }
  if (!(lobes & kLobeSpecular) || !specularAny_) return std::nullopt;
  const float rest = std::min((uLobe - diffuse) / (1 - diffuse), 0x1.fffffep-1f);  // rounding reaches 1
  std::optional<BsdfSample> s = sampleSpecular(rest, u);
  if (!s || diffuse == 0) return s;
  if (s->delta) {
    s->weight /= 1 - diffuse;
    return s;
  }
  s->pdf = pdf(s->direction, lobes);
  if (!(s->pdf > 0)) return std::nullopt;
  s->weight = eval(s->direction, lobes) / s->pdf;
  return s;
}

BsdfSample Bsdf::deltaReflection() const {
  BsdfSample s;
  s.delta = true;
  s.direction = glm::normalize(frame_.toWorld(Vec3(-v_.x, -v_.y, v_.z)));
  s.weight = specularAny_ ? facet(v_.z).reflect : Vec3(0);
  return s;
}

std::optional<BsdfSample> Bsdf::deltaTransmission() const {
  if (glass_ <= 0) return std::nullopt;
  BsdfSample s;
  s.delta = s.transmitted = true;
  s.weight = facet(v_.z).transmit;
  const Vec3 l = thin_ ? -v_ : refract(Vec3(0, 0, 1), v_.z);
  s.direction = glm::normalize(frame_.toWorld(l));
  if (l.z >= 0 || !sideAgrees(s.direction, l) || largest(s.weight) <= 0) return std::nullopt;
  return s;
}

}  // namespace saccade::raytrace
