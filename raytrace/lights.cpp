#include "raytrace/lights.h"

#include <algorithm>
#include <cmath>

#include "raytrace/bsdf.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

/// Shadow rays stop this fraction short of a light, about the rounding of both end points.
constexpr float kShadowEnd = 1 - 0x1p-12f;

}  // namespace

float spotFactor(const core::PunctualLight& light, float cosAxis) {
  if (light.type != core::PunctualLight::Type::spot) return 1;
  const float t =
      std::clamp((cosAxis - light.cosOuter) / std::max(1e-3f, light.cosInner - light.cosOuter), 0.0f, 1.0f);
  return t * t;
}

float rangeFactor(float range, float distance) {
  if (!(range > 0)) return 1;
  const float part = distance / range, square = part * part;
  return std::clamp(1 - square * square, 0.0f, 1.0f);
}

Lights::Lights(const core::Scene& scene, const World& world) : scene_(scene), world_(world) {
  addEmissive(scene);
  addPunctual(scene);
  addEnvironment(scene);
  std::vector<double> powers;
  for (const Group& g : groups_) powers.push_back(g.power);
  if (AliasTable(powers).empty()) groups_.clear(), powers.clear();
  if (groups_.size() > kFewGroups || emissive_.size() > kFewTriangles) buildTree();
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
  choice.byTree = byTree();
  float sum = 0;
  if (choice.byTree) {
    const auto parallel = static_cast<float>(parallelTable_.total());
    if (environment_ || parallel > 0) sum = parallel + tree_.irradiance(point);
    if (parallel > 0) choice.parallel = tree_.empty() ? 1 : parallel / sum;
  } else {
    for (std::size_t i = 0; i < groups_.size(); ++i)
      choice.cumulative[i] = sum += estimate(groups_[i], point);
  }
  if (environment_) choice.environment = environmentShare(sum);
  return choice;
}

/// By mean irradiance: neither is neglected, since neither estimate knows what stands in the way.
float Lights::environmentShare(float others) const {
  constexpr float kLeast = 0.1f;
  if (!(others > 0)) return 1;
  const auto environment = static_cast<float>(environment_->total() / 4);
  return std::clamp(environment / (environment + others), kLeast, 1 - kLeast);
}

float Lights::groupProbability(const LightChoice& choice, std::uint32_t group) const {
  const float total = choice.cumulative[groups_.size() - 1];
  const float below = group > 0 ? choice.cumulative[group - 1] : 0;
  return total > 0 ? (choice.cumulative[group] - below) / total : 0;
}

bool Lights::sampleTriangle(const Emissive& e, float choice, const Vec3& point, const Vec2& u,
                            LightSample& out) const {
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
  out.radiance = emissionAt(world_, e.triangle, b.x, b.y);
  out.pdf *= choice / e.area * squared / facing;
  out.delta = false;
  return std::isfinite(out.pdf) && out.pdf > 0;
}

float Lights::meanRadiance(std::size_t i) const {
  const Emissive& e = emissive_[i];
  const float sides = e.doubleSided ? 2 : 1;
  return groups_[e.group].power * e.choiceInGroup / (sides * core::kPi * e.area);
}

bool Lights::samplePunctual(std::size_t index, const Vec3& point, LightSample& out) const {
  const core::PunctualLight& light = scene_.lights[index];
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
  const float factor =
      spotFactor(light, -glm::dot(out.direction, light.direction)) * rangeFactor(light.range, out.distance);
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
  return choice.byTree ? sampleByTree(choice, uLight, u, out) : sampleByGroup(choice, uLight, u, out);
}

bool Lights::sampleByGroup(const LightChoice& choice, float uLight, const Vec2& u, LightSample& out) const {
  const auto n = static_cast<std::uint32_t>(groups_.size());
  const float total = choice.cumulative[n - 1];
  if (!(total > 0)) return false;
  const float target = std::min(uLight, AliasTable::kBelowOne) * total;
  std::uint32_t g = 0;
  while (g + 1 < n && choice.cumulative[g] <= target) ++g;
  const float below = g > 0 ? choice.cumulative[g - 1] : 0;
  const float share = choice.cumulative[g] - below;
  if (!(share > 0)) return false;
  out.pdf *= share / total;
  const Group& group = groups_[g];
  if (group.punctual >= 0) return samplePunctual(static_cast<std::size_t>(group.punctual), choice.point, out);
  float rest = std::clamp((target - below) / share, 0.0f, AliasTable::kBelowOne);
  const Emissive& e = emissive_[group.first + group.triangles.sample(rest, rest)];
  return sampleTriangle(e, e.choiceInGroup, choice.point, u, out);
}

bool Lights::sampleByTree(const LightChoice& choice, float uLight, const Vec2& u, LightSample& out) const {
  if (choice.parallel > 0) {
    if (uLight < choice.parallel || tree_.empty()) {
      float rest = 0;
      const std::uint32_t i = parallelTable_.sample(uLight / choice.parallel, rest);
      out.pdf *= choice.parallel * parallelTable_.probability(i);
      return samplePunctual(static_cast<std::size_t>(groups_[parallelGroups_[i]].punctual), choice.point,
                            out);
    }
    uLight = (uLight - choice.parallel) / (1 - choice.parallel);
    out.pdf *= 1 - choice.parallel;
  }
  LightTree::Drawn drawn;
  if (!tree_.draw(choice.point, uLight, drawn)) return false;
  if (drawn.lamp < emissive_.size())
    return sampleTriangle(emissive_[drawn.lamp], drawn.probability, choice.point, u, out);
  out.pdf *= drawn.probability;
  return samplePunctual(
      static_cast<std::size_t>(groups_[treeGroups_[drawn.lamp - emissive_.size()]].punctual), choice.point,
      out);
}

float Lights::pdf(const LightChoice& choice, std::uint32_t triangle, const Vec3& direction, float t) const {
  const std::int32_t light = world_.record(triangle).light;
  if (light < 0) return 0;
  const Emissive& e = emissive_[light];
  const float cosine = -glm::dot(e.normal, direction);
  const float facing = e.doubleSided ? std::fabs(cosine) : cosine;
  if (!(facing > 0)) return 0;
  const float others = 1 - choice.environment;
  if (choice.byTree) {
    const float chosen = others * (1 - choice.parallel) * tree_.probability(choice.point, light);
    return chosen / e.area * t * t / facing;
  }
  return others * groupProbability(choice, e.group) * e.choiceInGroup / e.area * t * t / facing;
}

Ray shadowRay(const Vec3& origin, const LightSample& light) {
  return {origin, light.direction, 0, light.distance * kShadowEnd};
}

Ray shadowRay(const Surface& from, const LightSample& light) {
  const Ray ray = from.leave(light.direction);
  if (!std::isfinite(light.distance)) return ray;
  // From where the ray really starts: of a lamp so near that this shift matters the ray would end behind it.
  const Vec3 way = from.position + light.direction * light.distance - ray.origin;
  LightSample shifted;
  shifted.distance = glm::length(way);
  shifted.direction = shifted.distance > 0 ? way / shifted.distance : light.direction;
  return shadowRay(ray.origin, shifted);
}

}  // namespace saccade::raytrace
