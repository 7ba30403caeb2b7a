#include "raytrace/lights.h"

#include <algorithm>
#include <cmath>

#include "raytrace/bsdf.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

/// Largest float below 1.
constexpr float kBelowOne = 0x1.fffffep-1f;

/// Shadow rays stop this fraction short of a light, about the rounding of both end points.
constexpr float kShadowEnd = 1 - 0x1p-12f;

Vec2 uniformTriangle(const Vec2& u) {
  const float root = std::sqrt(u.x);
  return {1 - root, u.y * root};  // barycentric u, v
}

/// Mean emission over a triangle, from the centroids of 16 equal parts.
Vec3 meanEmission(const CompiledMaterial& m, const TriangleRecord& r) {
  if (!m.emissionTexture) return m.emission;
  constexpr int kParts = 4;
  Vec3 sum(0);
  const auto add = [&](float u, float v) {
    const Vec2 uv = r.uv0[0] * (1 - u - v) + r.uv0[1] * u + r.uv0[2] * v;
    sum += Vec3(m.emissionTexture.sample(uv));
  };
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; j < kParts - i; ++j) {
      add((static_cast<float>(i) + 1 / 3.0f) / kParts, (static_cast<float>(j) + 1 / 3.0f) / kParts);
      if (i + j < kParts - 1) {
        add((static_cast<float>(i) + 2 / 3.0f) / kParts, (static_cast<float>(j) + 2 / 3.0f) / kParts);
      }
    }
  }
  return m.emission * sum / static_cast<float>(kParts * kParts);
}

/// glTF's spot falloff, [0, 1].
float spotFactor(const core::PunctualLight& light, float cosAxis) {
  if (light.type != core::PunctualLight::Type::spot) return 1;
  const float t =
      std::clamp((cosAxis - light.cosOuter) / std::max(1e-3f, light.cosInner - light.cosOuter), 0.0f, 1.0f);
  return t * t;
}

}  // namespace

AliasTable::AliasTable(std::span<const double> weights) {
  for (double w : weights) total_ += w;
  if (!(total_ > 0) || !std::isfinite(total_)) {
    total_ = 0;
    return;
  }
  const std::size_t n = weights.size();
  slots_.resize(n);
  std::vector<double> scaled(n);
  std::vector<std::uint32_t> small, large;
  for (std::size_t i = 0; i < n; ++i) {
    slots_[i].probability = static_cast<float>(weights[i] / total_);
    scaled[i] = weights[i] / total_ * static_cast<double>(n);
    (scaled[i] < 1 ? small : large).push_back(static_cast<std::uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t s = small.back(), l = large.back();
    small.pop_back();
    slots_[s].keep = static_cast<float>(scaled[s]);
    slots_[s].alias = l;
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
}

std::uint32_t AliasTable::sample(float u, float& rest) const {
  const float scaled = std::min(u, kBelowOne) * static_cast<float>(slots_.size());
  const auto i = std::min(static_cast<std::uint32_t>(scaled), static_cast<std::uint32_t>(slots_.size() - 1));
  const float part = std::clamp(scaled - static_cast<float>(i), 0.0f, kBelowOne);
  const Slot& slot = slots_[i];
  if (part < slot.keep) {
    rest = std::min(part / slot.keep, kBelowOne);
    return i;
  }
  rest = std::min((part - slot.keep) / (1 - slot.keep), kBelowOne);
  return slot.alias;
}

Lights::Lights(const core::Scene& scene, const World& world) : scene_(scene), world_(world) {
  addEmissive(scene);
  addPunctual(scene);
  addEnvironment(scene);
  std::vector<double> powers;
  for (const Group& g : groups_) powers.push_back(g.power);
  groupTable_ = AliasTable(powers);
  if (groupTable_.empty()) groups_.clear(), powers.clear();
  if (environment_) {
    const double radius = 0.5 * static_cast<double>(scene.bounds.diagonal());
    powers.push_back(M_PI * radius * radius * environment_->total());
  }
  emissionTable_ = AliasTable(powers);
}

void Lights::addEnvironment(const core::Scene& scene) {
  if (!scene.environment) return;
  environment_ = std::make_unique<EnvironmentLight>(scene.environment);
  if (!environment_->shines()) environment_.reset();
}

void Lights::addEmissive(const core::Scene& scene) {
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const CompiledMaterial& m = world_.materialOf(o);
    if (!m.emits()) continue;
    Group group;
    group.first = static_cast<std::uint32_t>(emissive_.size());
    std::vector<double> powers;
    core::Bounds bounds;
    for (std::uint32_t t = world_.firstTriangle(o); t < world_.firstTriangle(o + 1); ++t) {
      const TriangleShape& s = world_.shape(t);
      const Vec3 cross = glm::cross(s.position[1] - s.position[0], s.position[2] - s.position[0]);
      const float area = 0.5f * glm::length(cross);
      if (!(area > 0) || !std::isfinite(area)) continue;
      const double sides = m.doubleSided ? 2 : 1;
      const double power = sides * core::kPi * area * core::luminance(meanEmission(m, world_.record(t)));
      if (!(power > 0) || !std::isfinite(power)) continue;
      emissive_.push_back(
          {t, static_cast<std::uint32_t>(groups_.size()), area, 0, cross / (2 * area), m.doubleSided});
      powers.push_back(power);
      for (const Vec3& p : s.position) bounds.add(p);
    }
    if (powers.empty()) continue;
    group.count = static_cast<std::uint32_t>(powers.size());
    group.center = bounds.center();
    group.radius = 0.5f * bounds.diagonal();
    group.triangles = AliasTable(powers);
    group.power = static_cast<float>(group.triangles.total());
    bool flat = !m.doubleSided;
    const Vec3 normal = emissive_[group.first].normal;
    for (std::uint32_t i = 0; i < group.count; ++i) {
      Emissive& e = emissive_[group.first + i];
      e.choiceInGroup = group.triangles.probability(i);
      for (const Vec3& p : world_.shape(e.triangle).position) {
        flat = flat && std::fabs(glm::dot(p - group.center, normal)) <= 1e-4f * group.radius &&
               glm::dot(e.normal, normal) > 0;
      }
    }
    if (flat) group.normal = normal;
    groups_.push_back(std::move(group));
  }
}

void Lights::addPunctual(const core::Scene& scene) {
  const float sceneRadius = 0.5f * scene.bounds.diagonal();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const core::PunctualLight& light = scene.lights[i];
    Group group;
    group.punctual = static_cast<std::int32_t>(i);
    group.center = light.position;
    const float strength = core::luminance(light.intensity);
    switch (light.type) {
      case core::PunctualLight::Type::point:
        group.power = 4 * core::kPi * strength;
        break;
      case core::PunctualLight::Type::spot:
        group.power = 2 * core::kPi * (1 - light.cosOuter) * strength;
        break;
      case core::PunctualLight::Type::directional:
        group.power = core::kPi * sceneRadius * sceneRadius * strength;
        break;
    }
    if (!(group.power > 0) || !std::isfinite(group.power)) continue;
    groups_.push_back(std::move(group));
    hasPunctual_ = true;
  }
}

float Lights::estimate(const Group& group, const Vec3& point) const {
  if (group.punctual >= 0) {
    const core::PunctualLight& light = scene_.lights[group.punctual];
    if (light.type == core::PunctualLight::Type::directional) return core::luminance(light.intensity);
    const Vec3 to = point - light.position;
    const float squared = glm::dot(to, to);
    if (!(squared > 0)) return 0;
    if (light.type == core::PunctualLight::Type::spot &&
        glm::dot(to, light.direction) <= light.cosOuter * std::sqrt(squared)) {
      return 0;
    }
    return core::luminance(light.intensity) / squared;
  }
  const Vec3 to = point - group.center;
  const float squared = std::max(glm::dot(to, to), group.radius * group.radius);
  float cosine = 1;
  if (group.normal != Vec3(0)) {
    const float height = glm::dot(to, group.normal);
    if (height < -1e-3f * group.radius) return 0;
    cosine = std::max(height / std::sqrt(squared), 0.1f);
  }
  return group.power * cosine / (core::kPi * squared);
}

LightChoice Lights::choose(const Vec3& point) const {
  LightChoice choice;
  choice.point = point;
  choice.byPower = groups_.size() > kFewGroups;
  float sum = 0;
  if (!choice.byPower) {
    for (std::size_t i = 0; i < groups_.size(); ++i)
      choice.cumulative[i] = sum += estimate(groups_[i], point);
  }
  if (environment_) choice.environment = environmentShare(choice, sum);
  return choice;
}

/// By mean irradiance: neither is neglected, since neither estimate knows what stands in the way.
float Lights::environmentShare(const LightChoice& choice, float others) const {
  constexpr float kLeast = 0.1f;
  if (choice.byPower) return 0.5f;
  if (!(others > 0)) return 1;
  const auto environment = static_cast<float>(environment_->total() / 4);
  return std::clamp(environment / (environment + others), kLeast, 1 - kLeast);
}

float Lights::groupProbability(const LightChoice& choice, std::uint32_t group) const {
  if (choice.byPower) return groupTable_.probability(group);
  const float total = choice.cumulative[groups_.size() - 1];
  const float below = group > 0 ? choice.cumulative[group - 1] : 0;
  return total > 0 ? (choice.cumulative[group] - below) / total : 0;
}

bool Lights::sampleTriangle(const Group& group, const Vec3& point, float uTriangle, const Vec2& u,
                            LightSample& out) const {
  float rest = 0;
  const Emissive& e = emissive_[group.first + group.triangles.sample(uTriangle, rest)];
  const Vec2 b = uniformTriangle(u);
  const TriangleShape& s = world_.shape(e.triangle);
  const Vec3 position = s.position[0] * (1 - b.x - b.y) + s.position[1] * b.x + s.position[2] * b.y;
  const Vec3 to = position - point;
  const float squared = glm::dot(to, to);
  if (!(squared > 0)) return false;
  out.distance = std::sqrt(squared);
  out.direction = to / out.distance;
  const float cosine = -glm::dot(e.normal, out.direction);
  const float facing = e.doubleSided ? std::fabs(cosine) : cosine;
  if (!(facing > 0)) return false;
  const TriangleRecord& r = world_.record(e.triangle);
  const CompiledMaterial& m = world_.materialOf(r.object);
  out.radiance = m.emission;
  if (m.emissionTexture) {
    out.radiance *=
        Vec3(m.emissionTexture.sample(r.uv0[0] * (1 - b.x - b.y) + r.uv0[1] * b.x + r.uv0[2] * b.y));
  }
  out.pdf *= e.choiceInGroup / e.area * squared / facing;
  out.delta = false;
  return std::isfinite(out.pdf) && out.pdf > 0;
}

bool Lights::samplePunctual(const Group& group, const Vec3& point, LightSample& out) const {
  const core::PunctualLight& light = scene_.lights[group.punctual];
  out.delta = true;
  if (light.type == core::PunctualLight::Type::directional) {
    out.direction = -light.direction;
    out.distance = 4 * scene_.bounds.diagonal();
    out.radiance = light.intensity;
    return true;
  }
  const Vec3 to = light.position - point;
  const float squared = glm::dot(to, to);
  if (!(squared > 0)) return false;
  out.distance = std::sqrt(squared);
  out.direction = to / out.distance;
  const float factor = spotFactor(light, -glm::dot(out.direction, light.direction));
  out.radiance = light.intensity * (factor / squared);
  return factor > 0;
}

bool Lights::sampleEnvironment(const Vec2& u, LightSample& out) const {
  const EnvironmentSample s = environment_->sample(u);
  out.direction = s.direction;
  out.distance = core::kInfinity;
  out.radiance = s.radiance;
  out.pdf *= s.pdf;
  out.delta = false;
  return std::isfinite(out.pdf) && out.pdf > 0;
}

bool Lights::sample(const LightChoice& choice, float uLight, const Vec2& u, LightSample& out) const {
  out.pdf = 1;
  if (choice.environment > 0) {
    out.pdf = choice.environment;
    if (uLight < choice.environment || groups_.empty()) return sampleEnvironment(u, out);
    out.pdf = 1 - choice.environment;
    uLight = (uLight - choice.environment) / out.pdf;
  }
  if (groups_.empty()) return false;
  std::uint32_t g = 0;
  float rest = 0;
  if (choice.byPower) {
    g = groupTable_.sample(uLight, rest);
    out.pdf *= groupTable_.probability(g);
  } else {
    const auto n = static_cast<std::uint32_t>(groups_.size());
    const float total = choice.cumulative[n - 1];
    if (!(total > 0)) return false;
    const float target = std::min(uLight, kBelowOne) * total;
    while (g + 1 < n && choice.cumulative[g] <= target) ++g;
    const float below = g > 0 ? choice.cumulative[g - 1] : 0;
    const float share = choice.cumulative[g] - below;
    if (!(share > 0)) return false;
    rest = std::clamp((target - below) / share, 0.0f, kBelowOne);
    out.pdf *= share / total;
  }
  const Group& group = groups_[g];
  return group.punctual >= 0 ? samplePunctual(group, choice.point, out)
                             : sampleTriangle(group, choice.point, rest, u, out);
}

float Lights::pdf(const LightChoice& choice, std::uint32_t triangle, const Vec3& direction, float t) const {
  const std::int32_t light = world_.record(triangle).light;
  if (light < 0) return 0;
  const Emissive& e = emissive_[light];
  const float cosine = -glm::dot(e.normal, direction);
  const float facing = e.doubleSided ? std::fabs(cosine) : cosine;
  if (!(facing > 0)) return 0;
  const float group = (1 - choice.environment) * groupProbability(choice, e.group);
  return group * e.choiceInGroup / e.area * t * t / facing;
}

EmissionSample Lights::sampleEmission(float uLight, const Vec2& uPosition, const Vec2& uDirection) const {
  if (emissionTable_.empty()) return {};
  float rest = 0;
  const std::uint32_t g = emissionTable_.sample(uLight, rest);
  const float probability = emissionTable_.probability(g);
  if (g == groups_.size()) {
    const EnvironmentSample from = environment_->sample(uDirection);
    return emitFromAfar(-from.direction, from.radiance, from.pdf * probability, uPosition);
  }
  const Group& group = groups_[g];
  return group.punctual < 0 ? emitFromTriangle(group, probability, rest, uPosition, uDirection)
                            : emitFromPunctual(group, probability, uPosition, uDirection);
}

EmissionSample Lights::emitFromTriangle(const Group& group, float probability, float uTriangle,
                                        const Vec2& uPosition, const Vec2& uDirection) const {
  EmissionSample out;
  float rest = 0;
  const Emissive& e = emissive_[group.first + group.triangles.sample(uTriangle, rest)];
  const Vec2 b = uniformTriangle(uPosition);
  const TriangleShape& s = world_.shape(e.triangle);
  const TriangleRecord& r = world_.record(e.triangle);
  const CompiledMaterial& m = world_.materialOf(r.object);
  const bool back = e.doubleSided && rest < 0.5f;
  out.origin = s.position[0] * (1 - b.x - b.y) + s.position[1] * b.x + s.position[2] * b.y;
  out.normal = back ? -e.normal : e.normal;
  out.offset = r.offset;
  const float sine = std::sqrt(uDirection.x), angle = 2 * core::kPi * uDirection.y;
  out.direction = Frame(out.normal)
                      .toWorld({sine * std::cos(angle), sine * std::sin(angle),
                                std::sqrt(std::max(0.0f, 1 - uDirection.x))});
  Vec3 radiance = m.emission;
  if (m.emissionTexture) {
    radiance *= Vec3(m.emissionTexture.sample(r.uv0[0] * (1 - b.x - b.y) + r.uv0[1] * b.x + r.uv0[2] * b.y));
  }
  out.flux =
      radiance * (core::kPi * e.area * (e.doubleSided ? 2.0f : 1.0f) / (probability * e.choiceInGroup));
  return out;
}

/// Parallel light of this irradiance at normal incidence (the environment: radiance, and a density per solid
/// angle) on the disc that the scene's bounding sphere shows it.
EmissionSample Lights::emitFromAfar(const Vec3& direction, const Vec3& irradiance, float probability,
                                    const Vec2& uPosition) const {
  EmissionSample out;
  const float radius = 0.5f * scene_.bounds.diagonal();
  const float r = radius * std::sqrt(uPosition.x), a = 2 * core::kPi * uPosition.y;
  out.direction = direction;
  out.origin =
      scene_.bounds.center() + Frame(direction).toWorld({r * std::cos(a), r * std::sin(a), -2 * radius});
  out.flux = irradiance * (core::kPi * radius * radius / probability);
  return out;
}

EmissionSample Lights::emitFromPunctual(const Group& group, float probability, const Vec2& uPosition,
                                        const Vec2& uDirection) const {
  const core::PunctualLight& light = scene_.lights[group.punctual];
  if (light.type == core::PunctualLight::Type::directional)
    return emitFromAfar(light.direction, light.intensity, probability, uPosition);
  EmissionSample out;
  const bool spot = light.type == core::PunctualLight::Type::spot;
  const float lowest = spot ? light.cosOuter : -1.0f;
  const float cosine = 1 - uDirection.x * (1 - lowest), angle = 2 * core::kPi * uDirection.y;
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  out.origin = light.position;
  out.direction = Frame(light.direction).toWorld({sine * std::cos(angle), sine * std::sin(angle), cosine});
  out.flux = light.intensity * (spotFactor(light, cosine) * 2 * core::kPi * (1 - lowest) / probability);
  return out;
}

Ray shadowRay(const Surface& from, const LightSample& light) {
  Ray ray = from.leave(light.direction);
  ray.tFar = light.distance * kShadowEnd;
  return ray;
}

}  // namespace saccade::raytrace
