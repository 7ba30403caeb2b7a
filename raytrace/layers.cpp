#include "raytrace/layers.h"

#include <algorithm>
#include <cmath>

#include "core/scene/sheen.h"

namespace saccade::raytrace {

Coat::Coat(float weight, float roughness, const Vec3& normal, const Vec3& v)
    : frame_(normal), v_(frame_.toLocal(v)), weight_(weight), roughness_(roughness) {
  v_.z = std::max(v_.z, kLowestCosine);
  alpha_ = roughness * roughness;
  delta_ = alpha_ < kDeltaAlpha;
  if (!delta_) lambdaV_ = ggxLambda(v_.z, alpha_);
  passedV_ = core::coatTransmission(weight_, roughness_, v_.z);
}

float Coat::reflectance(float cosVH) const { return weight_ * schlick(Vec3(core::kCoatF0), 1, cosVH).x; }

float Coat::cosine(const Vec3& l) const { return std::min(std::fabs(glm::dot(l, frame_.n)), 1.0f); }

float Coat::passed(const Vec3& l) const { return core::coatTransmission(weight_, roughness_, cosine(l)); }

Vec3 Coat::eval(const Vec3& direction) const {
  const Vec3 l = frame_.toLocal(direction);
  if (delta_ || l.z <= 0) return Vec3(0);
  const Vec3 h = glm::normalize(v_ + l);
  const float g2 = 1 / (1 + lambdaV_ + ggxLambda(l.z, alpha_));
  return Vec3(reflectance(glm::dot(v_, h)) * ggxD(h, alpha_) * g2 / (4 * v_.z));
}

float Coat::pdf(const Vec3& direction) const {
  const Vec3 l = frame_.toLocal(direction);
  if (delta_ || l.z <= 0) return 0;
  return ggxD(glm::normalize(v_ + l), alpha_) / ((1 + lambdaV_) * 4 * v_.z);
}

std::optional<LocalSample> Coat::sample(const Vec2& u) const {
  if (delta_) return mirror();
  const Vec3 h = sampleVisibleNormal(v_, alpha_, u);
  const float vh = std::clamp(glm::dot(v_, h), 0.0f, 1.0f);
  const Vec3 l = 2 * vh * h - v_;
  if (l.z <= 0) return std::nullopt;
  LocalSample s;
  s.direction = frame_.toWorld(l);
  s.pdf = ggxD(h, alpha_) / ((1 + lambdaV_) * 4 * v_.z);
  s.weight = Vec3(reflectance(vh) * (1 + lambdaV_) / (1 + lambdaV_ + ggxLambda(l.z, alpha_)));
  return s;
}

LocalSample Coat::mirror() const {
  LocalSample s;
  s.delta = true;
  s.direction = frame_.toWorld(Vec3(-v_.x, -v_.y, v_.z));
  s.weight = Vec3(reflectance(v_.z));
  return s;
}

Sheen::Sheen(const Vec3& color, float roughness, const Vec3& v)
    : v_(v), color_(color), roughness_(roughness), largest_(largest(color)) {
  passedV_ = core::sheenTransmission(largest_, roughness_, v_.z);
}

float Sheen::passed(const Vec3& l) const {
  return core::sheenTransmission(largest_, roughness_, std::fabs(l.z));
}

Vec3 Sheen::eval(const Vec3& l) const {
  if (l.z <= 0) return Vec3(0);
  const Vec3 h = glm::normalize(v_ + l);
  return color_ * core::sheenLobe(v_.z, l.z, h.z, roughness_);
}

std::optional<LocalSample> Sheen::sample(const Vec2& u) const {
  const float phi = 2 * core::kPi * u.y, z = 1 - u.x, s = std::sqrt(std::max(0.0f, 1 - z * z));
  LocalSample sample;
  sample.direction = {s * std::cos(phi), s * std::sin(phi), z};
  sample.pdf = pdf(sample.direction);
  sample.weight = eval(sample.direction) / sample.pdf;
  return sample;
}

}  // namespace saccade::raytrace
