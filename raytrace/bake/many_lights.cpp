#include "raytrace/bake/many_lights.h"

#include <algorithm>
#include <cmath>

#include "raytrace/bsdf.h"

namespace saccade::raytrace {
namespace {

constexpr int kMaxSheets = 16;  // see-through surfaces that a ray by the cosine passes

/// Calls take(uLight, factor): numbers for Lights::sample and the factor its result is to be taken by, so
/// that the sum is an estimate of all lights but the environment. Few lights are all taken, at a place in
/// each that uLight says. Unused entries of `cumulative` are 0, so it falls where the groups end.
template <class Visit>
void forEachLight(const LightChoice& choice, float uLight, Visit&& take) {
  const float others = 1 - choice.environment;
  if (others == 0) return;
  const auto visit = [&](float place, float factor) {
    take(choice.environment + place * others, factor * others);
  };
  constexpr int kAllOf = 4;
  const auto groups = std::find_if(choice.cumulative + 1, choice.cumulative + LightChoice::kFewGroups,
                                   [&](const float& c) { return c < *(&c - 1); });
  if (choice.byTree || groups - choice.cumulative > kAllOf) {
    visit(uLight, 1.0f);
    return;
  }
  const float total = *(groups - 1);
  float below = 0;
  for (const float* c = choice.cumulative; c != groups && total > 0; below = *c++) {
    const float share = (*c - below) / total;
    if (share > 0) visit(below / total + uLight * share, share);
  }
}

/// Power heuristic (Veach 1997) for the light samples, of which there are kCosineEvery times as many.
float lightWeight(float pdfLight, float pdfCosine) {
  const float l = pdfLight * kCosineEvery;
  return l * l / (l * l + pdfCosine * pdfCosine);
}

}  // namespace

Vec3 sampleLights(const World& world, const Receiver& at, const LightChoice& choice, float uLight,
                  const Vec2& u, RayCounters& counters) {
  Vec3 sum(0);
  forEachLight(choice, uLight, [&](float place, float factor) {
    LightSample light;
    if (!world.lights().sample(choice, place, u, light)) return;
    const float cosine = at.cosine(light.direction);
    if (!(cosine > 0) || !(light.pdf > 0)) return;
    const float free = world.transmittance(shadowRay(at.surface, light), counters);
    if (!(free > 0)) return;
    if (!light.delta) {
      factor *= lightWeight(light.pdf, glm::dot(light.direction, at.surface.ng) / core::kPi);
    }
    sum += light.radiance * (cosine * free * factor / light.pdf);
  });
  return sum;
}

Vec3 sampleEnvironment(const World& world, const Receiver& at, const EnvironmentLight& environment,
                       const Vec2& u, RayCounters& counters) {
  const EnvironmentSample s = environment.sample(u);
  const float cosine = at.cosine(s.direction);
  if (!(cosine > 0) || !(s.pdf > 0)) return Vec3(0);
  const float free = world.transmittance(at.surface.leave(s.direction), counters);
  const float weight = lightWeight(s.pdf, glm::dot(s.direction, at.surface.ng) / core::kPi);
  return s.radiance * (cosine * free * weight / s.pdf);
}

Vec3 sampleCosine(const World& world, const Receiver& at, const LightChoice* choice, const Vec2& u,
                  RayCounters& counters) {
  const float sine = std::sqrt(u.x), angle = 2 * core::kPi * u.y, up = std::sqrt(std::max(0.0f, 1 - u.x));
  const Vec3 direction = Frame(at.surface.ng).toWorld({sine * std::cos(angle), sine * std::sin(angle), up});
  const float cosine = at.cosine(direction);
  float free = 1;
  Ray ray = at.surface.leave(direction);
  for (int sheet = 0; sheet < kMaxSheets && cosine > 0 && up > 0; ++sheet) {
    Hit hit;
    if (!world.intersect(ray, hit, counters)) {
      const EnvironmentLight* environment = world.lights().environment();
      if (!environment) break;
      const float weight = 1 - lightWeight(environment->pdf(direction), up / core::kPi);
      return environment->radiance(direction) * (free * weight * core::kPi * cosine / up);
    }
    const Surface met = makeSurface(world, hit, direction);
    if (choice && world.record(hit.triangle).light >= 0) {
      const float distance = glm::length(met.position - at.surface.position);
      const float pdf = world.lights().pdf(*choice, hit.triangle, direction, distance);
      const float weight = 1 - lightWeight(pdf, up / core::kPi);
      return met.emitted() * (met.point.coverage * free * weight * core::kPi * cosine / up);
    }
    free *= 1 - met.point.coverage;
    if (!(free > 0)) break;
    ray = met.leave(direction);
  }
  return Vec3(0);
}

}  // namespace saccade::raytrace
