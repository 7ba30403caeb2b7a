// Where particles start.
#include <algorithm>
#include <cmath>

#include "raytrace/bsdf.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

EmissionSample Lights::sampleEmission(float uLight, const Vec2& uPosition, const Vec2& uDirection,
                                      const EmissionAim* aim, const EmissionAim::Chance& chance) const {
  if (emissionTable_.empty()) return {};
  float rest = 0;
  const std::uint32_t g = emissionTable_.sample(uLight, rest);
  const float probability = emissionTable_.probability(g);
  const Aiming aiming{aim, chance};
  if (g == groups_.size()) {
    const EnvironmentSample from = environment_->sample(uDirection);
    return emitFromAfar(-from.direction, from.radiance, from.pdf * probability, uPosition, aiming);
  }
  const Group& group = groups_[g];
  return group.punctual < 0 ? emitFromTriangle(group, probability, rest, uPosition, uDirection, aiming)
                            : emitFromPunctual(group, probability, uPosition, uDirection, aiming);
}

EmissionSample Lights::emitFromTriangle(const Group& group, float probability, float uTriangle,
                                        const Vec2& uPosition, const Vec2& uDirection,
                                        const Aiming& aiming) const {
  EmissionSample out;
  float rest = 0;
  const Emissive& e = emissive_[group.first + group.triangles.sample(uTriangle, rest)];
  const Vec2 b = uniformTriangle(uPosition);
  const TriangleShape& s = world_.shape(e.triangle);
  const bool back = e.doubleSided && rest < 0.5f;
  out.origin = s.position[0] * (1 - b.x - b.y) + s.position[1] * b.x + s.position[2] * b.y;
  out.normal = back ? -e.normal : e.normal;
  out.offset = world_.record(e.triangle).offset;
  const float sine = std::sqrt(uDirection.x), angle = 2 * core::kPi * uDirection.y;
  out.direction = Frame(out.normal)
                      .toWorld({sine * std::cos(angle), sine * std::sin(angle),
                                std::sqrt(std::max(0.0f, 1 - uDirection.x))});
  float share = 1;
  if (aiming.aim) {
    const auto density = [&](const Vec3& d) { return std::max(0.0f, glm::dot(d, out.normal)) / core::kPi; };
    share = aiming.aim->fromPoint(out.origin, out.normal, aiming.chance, density, out.direction);
  }
  const Vec3 radiance = emissionAt(world_, e.triangle, b.x, b.y);
  out.flux = radiance *
             (share * core::kPi * e.area * (e.doubleSided ? 2.0f : 1.0f) / (probability * e.choiceInGroup));
  return out;
}

/// Parallel light of this irradiance at normal incidence (the environment: radiance, and a density per solid
/// angle) on the disc that the scene's bounding sphere shows it.
EmissionSample Lights::emitFromAfar(const Vec3& direction, const Vec3& irradiance, float probability,
                                    const Vec2& uPosition, const Aiming& aiming) const {
  EmissionSample out;
  const float radius = 0.5f * scene_.bounds.diagonal();
  const float r = radius * std::sqrt(uPosition.x), a = 2 * core::kPi * uPosition.y;
  out.direction = direction;
  out.origin =
      scene_.bounds.center() + Frame(direction).toWorld({r * std::cos(a), r * std::sin(a), -2 * radius});
  float share = 1;
  if (aiming.aim) {
    const auto density = [&](const Vec3& origin) {
      const Vec3 across = glm::cross(origin - scene_.bounds.center(), direction);
      return glm::dot(across, across) <= radius * radius ? 1 / (core::kPi * radius * radius) : 0.0f;
    };
    share = aiming.aim->fromAfar(direction, aiming.chance, density, out.origin);
  }
  out.flux = irradiance * (share * core::kPi * radius * radius / probability);
  return out;
}

EmissionSample Lights::emitFromPunctual(const Group& group, float probability, const Vec2& uPosition,
                                        const Vec2& uDirection, const Aiming& aiming) const {
  const core::PunctualLight& light = scene_.lights[group.punctual];
  if (light.type == core::PunctualLight::Type::directional)
    return emitFromAfar(light.direction, light.intensity, probability, uPosition, aiming);
  EmissionSample out;
  const bool spot = light.type == core::PunctualLight::Type::spot;
  const float lowest = spot ? light.cosOuter : -1.0f;
  const float cosine = 1 - uDirection.x * (1 - lowest), angle = 2 * core::kPi * uDirection.y;
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  out.origin = light.position;
  out.range = light.range;
  out.direction = Frame(light.direction).toWorld({sine * std::cos(angle), sine * std::sin(angle), cosine});
  float share = 1;
  if (aiming.aim) {
    const auto density = [&](const Vec3& d) {
      return !spot || glm::dot(d, light.direction) >= lowest ? 1 / (2 * core::kPi * (1 - lowest)) : 0.0f;
    };
    share = aiming.aim->fromPoint(out.origin, Vec3(0), aiming.chance, density, out.direction);
  }
  const float factor = share * spotFactor(light, glm::dot(out.direction, light.direction));
  out.flux = light.intensity * (factor * 2 * core::kPi * (1 - lowest) / probability);
  return out;
}

}  // namespace saccade::raytrace
