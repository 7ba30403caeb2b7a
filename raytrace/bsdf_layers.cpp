// Bsdf with sheen or a clearcoat over the base.
#include <algorithm>
#include <cmath>

#include "raytrace/bsdf.h"

namespace saccade::raytrace {
namespace {

constexpr unsigned kLobeOf[] = {kLobeDiffuse, kLobeBase, kLobeSheen, kLobeCoat};
constexpr int kDiffuse = 0, kBase = 1, kSheen = 2, kCoat = 3, kLobeCount = 4;

}  // namespace

void Bsdf::addLayers(const Surface& surface, const ExtensionPoint& extension) {
  if (extension.sheenColor != Vec3(0)) sheen_.emplace(extension.sheenColor, extension.sheenRoughness, v_);
  if (extension.clearcoat > 0) {
    coat_.emplace(extension.clearcoat, extension.clearcoatRoughness, frame_.toLocal(extension.coatNormal),
                  v_);
  }
  layered_ = sheen_ || coat_;
  if (!layered_) return;
  within_ = surface.closed && !surface.front && base_.transmits();
  const float passed = within_ ? 1 : (sheen_ ? sheen_->passedV() : 1) * (coat_ ? coat_->passedV() : 1);
  if (diffuseAny_) {
    estimates_[kDiffuse] = core::luminance(diffuseUnderMap()) * core::kPi;
  }
  estimates_[kBase] = passed * base_.estimate(core::directionalAlbedo(v_.z, roughness_));
  if (within_) return;
  if (sheen_) estimates_[kSheen] = sheen_->estimate() * (coat_ ? coat_->passedV() : 1);
  if (coat_) estimates_[kCoat] = coat_->estimate();
}

float Bsdf::estimate(unsigned lobes) const {
  float sum = 0;
  for (int i = 0; i < kLobeCount; ++i) sum += lobes & kLobeOf[i] ? estimates_[i] : 0;
  return sum;
}

/// What the coat lets through to and from the sheen.
float Bsdf::coatAttenuation(const Vec3& l) const {
  return coat_ ? std::min(coat_->passedV(), coat_->passed(l)) : 1;
}

/// What the layers let through to and from S and G. A solid has them on its outside only.
float Bsdf::attenuation(const Vec3& l) const {
  if (within_ && l.z > 0) return 1;
  const float passedL = (sheen_ ? sheen_->passed(l) : 1) * (coat_ ? coat_->passed(l) : 1);
  if (within_) return passedL;
  const float passedV = (sheen_ ? sheen_->passedV() : 1) * (coat_ ? coat_->passedV() : 1);
  return l.z < 0 && !base_.thin() ? passedV : std::min(passedV, passedL);
}

Vec3 Bsdf::evalLayered(const Vec3& wi, const Vec3& l, unsigned lobes) const {
  Vec3 f(0);
  if (l.z != 0 && sideAgrees(wi, l)) {
    if (lobes & kLobeDiffuse) f += evalDiffuse(l);
    if (lobes & kLobeBase) f += base_.eval(l) * attenuation(l);
    if ((lobes & kLobeSheen) && sheen_ && !within_) f += sheen_->eval(l) * coatAttenuation(l);
  }
  if ((lobes & kLobeCoat) && coat_ && !within_ && glm::dot(wi, ng_) > 0) f += coat_->eval(l);
  return f;
}

float Bsdf::pdfLayered(const Vec3& wi, const Vec3& l, unsigned lobes) const {
  const float total = estimate(lobes);
  if (!(total > 0)) return 0;
  float p = 0;
  const auto add = [&](int lobe, auto&& density) {
    if ((lobes & kLobeOf[lobe]) && estimates_[lobe] > 0) p += estimates_[lobe] / total * density();
  };
  if (l.z != 0 && sideAgrees(wi, l)) {
    add(kDiffuse, [&] { return std::max(l.z, 0.0f) / core::kPi; });
    add(kBase, [&] { return base_.pdf(l); });
    add(kSheen, [&] { return sheen_->pdf(l); });
  }
  if (glm::dot(wi, ng_) > 0) add(kCoat, [&] { return coat_->pdf(l); });
  return p;
}

std::optional<BsdfSample> Bsdf::sampleLayered(float uLobe, const Vec2& u, unsigned lobes) const {
  const float total = estimate(lobes);
  if (!(total > 0)) return std::nullopt;
  int lobe = -1;
  float below = 0, share = 0;
  for (int i = 0; i < kLobeCount; ++i) {
    if (!(lobes & kLobeOf[i]) || !(estimates_[i] > 0)) continue;
    below += share;  // rounding may leave uLobe above the sum: the last lobe takes it
    lobe = i;
    share = estimates_[i] / total;
    if (uLobe < below + share) break;
  }
  const float rest = std::clamp((uLobe - below) / share, 0.0f, 0x1.fffffep-1f);
  std::optional<LocalSample> local;
  if (lobe == kDiffuse) local = LocalSample{sampleCosine(u)};
  if (lobe == kBase) local = base_.sample(rest, u);
  if (lobe == kSheen) local = sheen_->sample(u);
  if (lobe == kCoat) local = coat_->sample(u);
  if (!local) return std::nullopt;
  BsdfSample s = toWorld(*local);
  const bool sound =
      lobe == kCoat ? glm::dot(s.direction, ng_) > 0 : sideAgrees(s.direction, local->direction);
  if (!sound) return std::nullopt;
  if (s.delta) {
    s.weight *= (lobe == kBase ? attenuation(local->direction) : 1) / share;
    return s;
  }
  s.pdf = pdf(s.direction, lobes);
  if (!(s.pdf > 0)) return std::nullopt;
  s.weight = eval(s.direction, lobes) / s.pdf;
  return s;
}

std::optional<BsdfSample> Bsdf::coatReflection() const {
  if (!coat_ || !coat_->delta() || within_) return std::nullopt;
  const BsdfSample s = toWorld(coat_->mirror());
  if (!(glm::dot(s.direction, ng_) > 0)) return std::nullopt;
  return s;
}

}  // namespace saccade::raytrace
