#include "raytrace/base_lobe.h"

#include <algorithm>
#include <cmath>

#include "core/scene/specular_albedo.h"

namespace saccade::raytrace {
namespace {

/// Below this difference from 1, an index bends nothing: rough refraction would be a delta anyway.
constexpr float kSameIndex = 1e-3f;

/// KHR_materials_anisotropy: alpha grows towards 1 along the tangent. The narrow one stays above the
/// threshold of deltas, else a brushed mirror would divide by 0.
Ggx anisotropic(float alpha, float strength) {
  const float along = alpha + (1 - alpha) * strength * strength;
  return along == alpha ? Ggx{alpha, alpha} : Ggx{along, std::max(alpha, kDeltaAlpha)};
}

}  // namespace

BaseLobe::BaseLobe(const Surface& surface, const Vec3& v) : v_(v) {
  const MaterialPoint& m = surface.point;
  const float alpha = m.roughness * m.roughness;
  ggx_ = {alpha, alpha};
  baseColor_ = m.baseColor;
  any_ = true;
  if (m.extension && m.extension->ward) {
    ward_ = *m.extension->ward;
    ggx_ = {ward_->alphaX, ward_->alphaY};
    delta_ = ggx_.widest() < kDeltaAlpha;
    ward_->alphaX = std::max(ward_->alphaX, kDeltaAlpha);
    ward_->alphaY = std::max(ward_->alphaY, kDeltaAlpha);
    lambert_ = mirror_ = 1;
    f90Dielectric_ = 0;
    return;
  }
  if (m.extension && m.extension->anisotropy > 0) ggx_ = anisotropic(alpha, m.extension->anisotropy);
  delta_ = ggx_.widest() < kDeltaAlpha;
  thin_ = !surface.closed;
  entering_ = surface.front || thin_;
  setIor(m.ior);
  glass_ = (1 - m.metallic) * m.transmission;
  mirror_ = 1 - glass_;
  lambert_ = (1 - m.metallic) * (1 - m.transmission);
  f0Dielectric_ = m.dielectricF0;
  f90Dielectric_ = m.dielectricF90;
  if (mirror_ > 0) {
    f0_ = (m.baseColor * m.metallic + m.dielectricF0 * lambert_) / mirror_;
    f90_ = (m.metallic + m.dielectricF90 * lambert_) / mirror_;
  }
  f0Estimate_ = f0_;
  if (m.extension && m.extension->film) addFilm(m.extension->film);
  lambdaV_ = delta_ ? 0 : ggx_.lambda(v_);
  plain_ = !delta_ && !(glass_ > 0) && !film_ && ggx_.isotropic();
}

void BaseLobe::addFilm(const core::ThinFilm& film) {
  film_ = film;
  underFilm_ = f0Dielectric_;
  if (lambert_ > 0) f0Dielectric_ = core::filmedF0(film_, underFilm_, f90Dielectric_);
  if (mirror_ > 0) {
    const float metallic = mirror_ - lambert_;
    const Vec3 metal = metallic > 0 ? core::filmedF0(film_, baseColor_, 1) : Vec3(0);
    f0Estimate_ = (metal * metallic + f0Dielectric_ * lambert_) / mirror_;
  }
}

void BaseLobe::setIor(float ior) {
  eta_ = entering_ ? ior : 1 / ior;
  straight_ = !thin_ && std::fabs(eta_ - 1) < kSameIndex;
}

float BaseLobe::estimate(const core::AlbedoPair& pair) const {
  if (ward_) return core::luminance(ward_->specular);
  return core::luminance(core::lobeAlbedo(pair, f0Estimate_, f90_)) * mirror_ + glass_;
}

BaseLobe::Interface BaseLobe::facet(float cosVH) const {
  Interface f{Vec3(0), Vec3(0)};
  if (ward_) {
    f.reflect = ward_->specular;
    return f;
  }
  if (mirror_ > 0) f.reflect = film_ ? filmedMirror(cosVH) : schlick(f0_, f90_, cosVH) * mirror_;
  if (glass_ > 0) {
    float r = fresnelDielectric(cosVH, eta_);
    if (film_) {
      const Vec3 filmed = filmedGlass(cosVH, r);
      f.reflect += glass_ * filmed;
      f.transmit = baseColor_ * glass_ * (Vec3(1) - filmed);
      return f;
    }
    if (thin_) r = 2 * r / (1 + r);
    f.reflect += Vec3(glass_ * r);
    f.transmit = baseColor_ * (glass_ * (1 - r));
  }
  return f;
}

/// S under a film: metal and dielectric apart, for the film is not linear in what lies below.
Vec3 BaseLobe::filmedMirror(float cosVH) const {
  const auto part = [&](float weight, const Vec3& f0, float f90) {
    if (!(weight > 0)) return Vec3(0);
    const Vec3 filmed = core::filmReflectance(film_, f0, cosVH) * f90;
    return weight * glm::mix(schlick(f0, f90, cosVH), filmed, film_.weight);
  };
  return part(mirror_ - lambert_, baseColor_, 1) + part(lambert_, underFilm_, f90Dielectric_);
}

/// The interface under a film on its outside, met from either side: the same along one path.
Vec3 BaseLobe::filmedGlass(float cosVH, float plain) const {
  Vec3 r(plain);
  float outside = cosVH;
  if (!entering_) outside = std::sqrt(std::max(0.0f, 1 - (1 - cosVH * cosVH) / (eta_ * eta_)));
  if (plain < 1) {  // not totally reflected
    const float root = (eta_ - 1) / (eta_ + 1);
    r = glm::mix(r, core::filmReflectance(film_, Vec3(root * root), outside), film_.weight);
  }
  return thin_ ? 2.0f * r / (Vec3(1) + r) : r;
}

float BaseLobe::reflectProbability(const Interface& f) const {
  const float reflect = core::luminance(f.reflect), transmit = core::luminance(f.transmit);
  return transmit > 0 ? reflect / (reflect + transmit) : 1;
}

bool BaseLobe::crossing(const Vec3& l, Crossing& c) const {
  if (glass_ <= 0 || straight_) return false;
  c.h = -(v_ + eta_ * l);
  if (c.h.z < 0) c.h = -c.h;
  const float length = glm::length(c.h);
  if (!(length > 0)) return false;
  c.h /= length;
  c.vh = glm::dot(v_, c.h);
  const float lh = glm::dot(l, c.h);
  if (c.vh <= 0 || lh >= 0) return false;
  c.jacobian = eta_ * eta_ * -lh / ((c.vh + eta_ * lh) * (c.vh + eta_ * lh));
  return true;
}

Vec3 BaseLobe::eval(const Vec3& l) const {
  if (!any_ || delta_) return Vec3(0);
  if (ward_) return l.z > 0 ? ward_->eval(v_, l) : Vec3(0);
  if (l.z > 0 || thin_) {
    const Vec3 up(l.x, l.y, std::fabs(l.z));
    const Vec3 h = glm::normalize(v_ + up);
    const Interface f = facet(glm::dot(v_, h));
    const float g2 = 1 / (1 + lambdaV_ + ggx_.lambda(up));
    return (l.z > 0 ? f.reflect : f.transmit) * (ggx_.d(h) * g2 / (4 * v_.z));
  }
  Crossing c;
  if (!crossing(l, c)) return Vec3(0);
  const float g2 = 1 / ((1 + lambdaV_) * (1 + ggx_.lambda(Vec3(l.x, l.y, -l.z))));
  return facet(c.vh).transmit * (ggx_.d(c.h) * g2 * c.vh / v_.z * c.jacobian);
}

float BaseLobe::pdf(const Vec3& l) const {
  if (!any_ || delta_) return 0;
  if (ward_) return l.z > 0 ? ward_->pdf(v_, l) : 0;
  const float g1 = 1 / (1 + lambdaV_);
  if (l.z > 0 || thin_) {
    const Vec3 h = glm::normalize(v_ + Vec3(l.x, l.y, std::fabs(l.z)));
    const float reflect = reflectProbability(facet(glm::dot(v_, h)));
    return ggx_.d(h) * g1 / (4 * v_.z) * (l.z > 0 ? reflect : 1 - reflect);
  }
  Crossing c;
  if (!crossing(l, c)) return 0;
  return ggx_.d(c.h) * g1 * c.vh / v_.z * c.jacobian * (1 - reflectProbability(facet(c.vh)));
}

Vec3 BaseLobe::refract(const Vec3& h, float cosVH) const {
  const float sine2 = std::max(0.0f, 1 - cosVH * cosVH) / (eta_ * eta_);
  const float cosT = std::sqrt(std::max(0.0f, 1 - sine2));
  return (cosVH / eta_ - cosT) * h - v_ / eta_;
}

std::optional<LocalSample> BaseLobe::sampleWard(const Vec2& u) const {
  if (delta_) return mirror();
  LocalSample s;
  s.direction = ward_->sample(v_, u);
  if (s.direction.z <= 0) return std::nullopt;
  s.pdf = ward_->pdf(v_, s.direction);
  s.weight = ward_->weight(v_, s.direction);
  return s;
}

/// sampleVisibleNormal, Schlick, ggxLambda and ggxD, side by side.
LocalLanes BaseLobe::sampleLanes(const Vec2 (&u)[kLanes]) const {
  const float alpha = ggx_.x, a2 = alpha * alpha;
  const Vec3 stretched = glm::normalize(Vec3(alpha * v_.x, alpha * v_.y, v_.z));
  Lanes height, cosine, sine;
  for (int k = 0; k < kLanes; ++k) {
    const float phi = 2 * core::kPi * u[k].y;
    height[k] = u[k].x;
    cosine[k] = std::cos(phi);
    sine[k] = std::sin(phi);
  }
  const Lanes z = (1.0f - height) * (1.0f + stretched.z) - stretched.z;
  const Lanes s = squareRoot(clampLanes(1.0f - z * z, 0, 1));
  const Vec3Lanes h =
      normalize(Vec3Lanes{alpha * (s * cosine + stretched.x), alpha * (s * sine + stretched.y),
                          atLeast(z + stretched.z, kLowestCosine)});
  const Lanes vh = clampLanes(dot(h, v_), 0, 1), twice = 2.0f * vh;
  LocalLanes out;
  out.direction = {twice * h.x - v_.x, twice * h.y - v_.y, twice * h.z - v_.z};
  const Lanes c2 = atLeast(out.direction.z * out.direction.z, kLeastCosine2);
  const Lanes lambda = 0.5f * (squareRoot(1.0f + a2 * atLeast(1.0f - c2, 0) / c2) - 1.0f);
  const Lanes shadowing = (1 + lambdaV_) / (1 + lambdaV_ + lambda);
  const Lanes m = clampLanes(1.0f - vh, 0, 1), m2 = m * m, m5 = m2 * m2 * m;
  const auto reflect = [&](float f0) { return (f0 + (f90_ - f0) * m5) * mirror_ * shadowing; };
  out.weight = {reflect(f0_.x), reflect(f0_.y), reflect(f0_.z)};
  const Lanes d = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
  out.pdf = a2 / (core::kPi * d * d) / ((1 + lambdaV_) * 4 * v_.z);
  return out;
}

std::optional<LocalSample> BaseLobe::sample(float uLobe, const Vec2& u) const {
  if (!any_) return std::nullopt;
  if (ward_) return sampleWard(u);
  const Vec3 h = delta_ ? Vec3(0, 0, 1) : ggx_.sampleVisible(v_, u);
  const float vh = std::clamp(glm::dot(v_, h), 0.0f, 1.0f);
  const Interface f = facet(vh);
  const float chance = reflectProbability(f);
  const bool reflected = uLobe < chance;
  Vec3 l = 2 * vh * h - v_;
  LocalSample s;
  s.transmitted = !reflected;
  s.delta = delta_;
  float shadowing = 1;  // G2 / G1(v)
  if (reflected || thin_) {
    if (l.z <= 0) return std::nullopt;
    if (!delta_) {
      shadowing = (1 + lambdaV_) / (1 + lambdaV_ + ggx_.lambda(l));
      s.pdf = ggx_.d(h) / ((1 + lambdaV_) * 4 * v_.z) * (reflected ? chance : 1 - chance);
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
      shadowing = 1 / (1 + ggx_.lambda(Vec3(l.x, l.y, -l.z)));
      s.pdf = ggx_.d(h) * vh * eta_ * eta_ * std::fabs(lh) * (1 - chance) /
              ((1 + lambdaV_) * v_.z * denominator * denominator);
    }
  }
  s.weight = (reflected ? f.reflect / chance : f.transmit / (1 - chance)) * shadowing;
  s.direction = l;
  return s;
}

LocalSample BaseLobe::mirror() const {
  LocalSample s;
  s.delta = true;
  s.direction = Vec3(-v_.x, -v_.y, v_.z);
  s.weight = any_ ? facet(v_.z).reflect : Vec3(0);
  return s;
}

std::optional<LocalSample> BaseLobe::refraction() const {
  if (glass_ <= 0) return std::nullopt;
  LocalSample s;
  s.delta = s.transmitted = true;
  s.weight = facet(v_.z).transmit;
  s.direction = thin_ ? -v_ : refract(Vec3(0, 0, 1), v_.z);
  if (s.direction.z >= 0 || largest(s.weight) <= 0) return std::nullopt;
  return s;
}

}  // namespace saccade::raytrace
