#include "raytrace/bsdf.h"

#include <algorithm>
#include <cmath>

#include "core/scene/specular_albedo.h"

namespace saccade::raytrace {
namespace {

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

Frame frameOf(const Surface& surface) {
  if (!surface.point.extension) return Frame(surface.ns);
  return {surface.ns, surface.point.extension->tangent};
}

Vec3 localEye(const Frame& frame, const Vec3& toEye) {
  Vec3 v = frame.toLocal(toEye);
  v.z = std::max(v.z, kLowestCosine);
  return v;
}

}  // namespace

Bsdf::Bsdf(const Surface& surface, const Vec3& toEye, DiffuseModel diffuseModel)
    : frame_(frameOf(surface)),
      ng_(surface.ng),
      v_(localEye(frame_, toEye)),
      base_(surface.scatters() ? BaseLobe(surface, v_) : BaseLobe()),
      diffuseModel_(diffuseModel) {
  if (!surface.scatters()) return;
  baseColor_ = surface.point.baseColor;
  roughness_ = surface.point.roughness;
  diffuseAny_ = base_.lambert() > 0 && largest(baseColor_) > 0;
  if (const auto& extension = surface.point.extension) {
    roughness_ = core::roughnessOverLambert(roughness_, extension->anisotropy);
    addLayers(surface, *extension);
  }
  if (!diffuseAny_ || layered_) return;
  const core::AlbedoPair pair = core::directionalAlbedo(v_.z, roughness_);
  const float specular = base_.estimate(pair);
  const float diffuse = core::luminance(baseColor_ * (Vec3(1) - core::lobeAlbedo(pair, base_.f0Dielectric(),
                                                                                 base_.f90Dielectric()))) *
                        base_.lambert();
  diffuseShare_ = diffuse > 0 ? diffuse / (diffuse + specular) : 0;
}

float Bsdf::diffuseProbability(unsigned lobes) const {
  if (!diffuseAny_ || !(lobes & kLobeDiffuse)) return 0;
  return lobes & kLobeSpecular ? diffuseShare_ : 1;
}

float Bsdf::diffuseChance() const {
  if (!layered_) return diffuseProbability(kLobeAll);
  const float total = estimate(kLobeAll);
  return total > 0 ? estimate(kLobeDiffuse) / total : 0;
}

unsigned Bsdf::roughLobes() const {
  unsigned lobes = 0;
  if (base_.any() && !base_.delta()) lobes |= kLobeBase;
  if (sheen_ && !within_) lobes |= kLobeSheen;
  if (coat_ && !coat_->delta() && !within_) lobes |= kLobeCoat;
  return lobes;
}

float Bsdf::alpha() const {
  if (!layered_) return base_.alpha();
  const unsigned rough = roughLobes();
  if (rough & kLobeSheen) return 1;
  return std::max(rough & kLobeBase ? base_.alpha() : 0.0f, rough & kLobeCoat ? coat_->alpha() : 0.0f);
}

bool Bsdf::sideAgrees(const Vec3& wiWorld, const Vec3& wiLocal) const {
  return wiLocal.z * glm::dot(wiWorld, ng_) > 0;
}

core::OverLambert Bsdf::overLambert() const {
  core::OverLambert over;
  over.f0 = base_.f0Dielectric();
  over.f90 = base_.f90Dielectric();
  over.roughness = roughness_;
  if (sheen_) {
    over.sheen = sheen_->weight();
    over.sheenRoughness = sheen_->roughness();
  }
  if (coat_) {
    over.coat = coat_->weight();
    over.coatRoughness = coat_->roughness();
  }
  return over;
}

Vec3 Bsdf::evalDiffuse(const Vec3& l) const {
  if (!diffuseAny_ || l.z <= 0) return Vec3(0);
  const float retro = diffuseModel_ == DiffuseModel::burley ? burleyFactor(v_, l, roughness_) : 1.0f;
  const float lambert = base_.lambert() / core::kPi * l.z * retro;
  if (layered_) {
    const core::OverLambert over = overLambert();
    const Vec3 tv = core::transmission(over, v_.z, coat_ ? coat_->cosine(v_) : 1);
    const Vec3 tl = core::transmission(over, l.z, coat_ ? coat_->cosine(l) : 1);
    return baseColor_ * lambert * tv * tl / glm::max(core::meanTransmission(over), Vec3(1e-4f));
  }
  const Vec3 &f0 = base_.f0Dielectric(),
             ev = core::lobeAlbedo(core::directionalAlbedo(v_.z, roughness_), f0, base_.f90Dielectric());
  const Vec3 el = core::lobeAlbedo(core::directionalAlbedo(l.z, roughness_), f0, base_.f90Dielectric());
  const Vec3 mean = core::lobeAlbedo(core::meanAlbedo(roughness_), f0, base_.f90Dielectric());
  const Vec3 room = glm::max(Vec3(1) - mean, Vec3(1e-4f));
  return baseColor_ * lambert * (Vec3(1) - ev) * (Vec3(1) - el) / room;
}

Vec3 Bsdf::diffuseUnderMap() const {
  if (!diffuseAny_) return Vec3(0);
  const float lambert = base_.lambert() / core::kPi;
  if (layered_) {
    return baseColor_ * core::transmission(overLambert(), v_.z, coat_ ? coat_->cosine(v_) : 1) * lambert;
  }
  const Vec3 ev = core::lobeAlbedo(core::directionalAlbedo(v_.z, roughness_), base_.f0Dielectric(),
                                   base_.f90Dielectric());
  return baseColor_ * (Vec3(1) - ev) * lambert;
}

Vec3 Bsdf::eval(const Vec3& wi, unsigned lobes) const {
  const Vec3 local = frame_.toLocal(wi);
  if (layered_) return evalLayered(wi, local, lobes);
  if (local.z == 0 || !sideAgrees(wi, local)) return Vec3(0);
  Vec3 f(0);
  if (lobes & kLobeDiffuse) f += evalDiffuse(local);
  if (lobes & kLobeBase) f += base_.eval(local);
  return f;
}

float Bsdf::pdf(const Vec3& wi, unsigned lobes) const {
  const Vec3 local = frame_.toLocal(wi);
  if (layered_) return pdfLayered(wi, local, lobes);
  if (local.z == 0 || !sideAgrees(wi, local)) return 0;
  const float diffuse = diffuseProbability(lobes);
  float p = diffuse > 0 && local.z > 0 ? diffuse * local.z / core::kPi : 0;
  if ((lobes & kLobeBase) && diffuse < 1) p += (1 - diffuse) * base_.pdf(local);
  return p;
}

Vec3 Bsdf::sampleCosine(const Vec2& u) {
  const float r = std::sqrt(u.x), phi = 2 * core::kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u.x))};
}

std::optional<BsdfSample> Bsdf::sample(float uLobe, const Vec2& u, unsigned lobes) const {
  if (layered_) return sampleLayered(uLobe, u, lobes);
  const float diffuse = diffuseProbability(lobes);
  if (uLobe < diffuse) {
    const Vec3 l = sampleCosine(u);
    BsdfSample s;
    s.direction = glm::normalize(frame_.toWorld(l));
    s.pdf = pdf(s.direction, lobes);
    if (!(s.pdf > 0) || l.z <= 0) return std::nullopt;
    s.weight = eval(s.direction, lobes) / s.pdf;
    return s;
  }
  if (!(lobes & kLobeBase)) return std::nullopt;
  const float rest = std::min((uLobe - diffuse) / (1 - diffuse), 0x1.fffffep-1f);  // rounding reaches 1
  const std::optional<LocalSample> local = base_.sample(rest, u);
  if (!local) return std::nullopt;
  BsdfSample s = toWorld(*local);
  if (!sideAgrees(s.direction, local->direction)) return std::nullopt;
  if (diffuse == 0) return s;
  if (s.delta) {
    s.weight /= 1 - diffuse;
    return s;
  }
  s.pdf = pdf(s.direction, lobes);
  if (!(s.pdf > 0)) return std::nullopt;
  s.weight = eval(s.direction, lobes) / s.pdf;
  return s;
}

BsdfLanes Bsdf::sampleLanes(const Vec2 (&u)[kLanes]) const {
  const LocalLanes local = base_.sampleLanes(u);
  const Vec3Lanes& l = local.direction;
  const auto world = [&](float t, float b, float n) { return l.x * t + l.y * b + l.z * n; };
  const Vec3Lanes wi = normalize(Vec3Lanes{world(frame_.t.x, frame_.b.x, frame_.n.x),
                                           world(frame_.t.y, frame_.b.y, frame_.n.y),
                                           world(frame_.t.z, frame_.b.z, frame_.n.z)});
  const Lanes above = dot(wi, ng_);
  return {wi, local.weight, local.pdf, l.z > Lanes{} ? l.z * above : Lanes{}};
}

BsdfSample Bsdf::deltaReflection() const {
  const LocalSample local = base_.mirror();
  BsdfSample s = toWorld(local);
  if (layered_) s.weight *= attenuation(local.direction);
  return s;
}

std::optional<BsdfSample> Bsdf::deltaTransmission() const {
  const std::optional<LocalSample> local = base_.refraction();
  if (!local) return std::nullopt;
  BsdfSample s = toWorld(*local);
  if (!sideAgrees(s.direction, local->direction)) return std::nullopt;
  if (layered_) s.weight *= attenuation(local->direction);
  return s;
}

}  // namespace saccade::raytrace
