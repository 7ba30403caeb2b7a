// Where particles start.
#include <algorithm>
#include <cmath>

#include "raytrace/bsdf.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

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
  const bool back = e.doubleSided && rest < 0.5f;
  out.origin = s.position[0] * (1 - b.x - b.y) + s.position[1] * b.x + s.position[2] * b.y;
  out.normal = back ? -e.normal : e.normal;
  out.offset = world_.record(e.triangle).offset;
  const float sine = std::sqrt(uDirection.x), angle = 2 * core::kPi * uDirection.y;
  out.direction = Frame(out.normal)
                      .toWorld({sine * std::cos(angle), sine * std::sin(angle),
                                std::sqrt(std::max(0.0f, 1 - uDirection.x))});
  const Vec3 radiance = emissionAt(world_, e.triangle, b.x, b.y);
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
  out.range = light.range;
  out.direction = Frame(light.direction).toWorld({sine * std::cos(angle), sine * std::sin(angle), cosine});
  out.flux = light.intensity * (spotFactor(light, cosine) * 2 * core::kPi * (1 - lowest) / probability);
  return out;
}

}  // namespace saccade::raytrace
