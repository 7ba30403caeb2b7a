#include "raytrace/walk.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::raytrace {
namespace {

/// Both branches of a smooth dielectric are followed at the first hits while each matters; later one is
/// drawn.
constexpr int kSplitDepth = 2;
constexpr float kSplitWeight = 0.01f;
/// Beyond the first hit, a branch lighter than this survives with probability weight / kRouletteWeight.
constexpr float kRouletteWeight = 0.1f;
/// Shadow rays whose contribution to the pixel cannot exceed this (radiance) are drawn likewise.
constexpr float kFaintLight = 0.02f;
/// A lobe below this GGX alpha finds lamps by itself: a light sample falls into it too seldom to pay.
/// Punctual lights have no size and are sampled for every rough lobe.
constexpr float kNarrowAlpha = 0.04f;
/// Blended layers that one ray passes.
constexpr int kMaxLayers = 64;

float powerHeuristic(float a, float b) {
  const float a2 = a * a, b2 = b * b;
  return a2 > 0 ? a2 / (a2 + b2) : 0;
}

}  // namespace

float Walk::emissionWeight(const Hit& hit, const Vec3& direction, float distance,
                           const RoughRay* rough) const {
  if (!rough) return 1;
  return powerHeuristic(rough->density,
                        world_.lights().pdf(*rough->choice, hit.triangle, direction, distance));
}

/// What a ray that leaves the scene brings back.
Vec3 Walk::environment(const Vec3& direction, const RoughRay* rough) const {
  const EnvironmentLight* light = world_.lights().environment();
  if (!light) return Vec3(0);
  const float weight =
      rough ? powerHeuristic(rough->density, world_.lights().environmentPdf(*rough->choice, direction))
            : 1.0f;
  return light->radiance(direction) * weight;
}

Vec3 Walk::received(const Leg& leg, int depth, float weight, const RoughRay* rough) {
  Vec3 sum(0);
  float through = 1, travelled = 0;
  Ray ray = leg.ray;
  Hit hit = leg.hit;
  bool met = leg.met;
  for (int layer = 0; layer < kMaxLayers && met; ++layer) {
    travelled += hit.t;
    float coverage = 1;
    Vec3 radiance(0), emitted(0);
    if (showsBase(hit, depth)) {
      const BaseLight base = layer == 0 ? leg.base->read() : baseLight(world_, hit, ray.direction);
      coverage = base.coverage;
      radiance = base.reflected;
      emitted = base.emitted;
    } else {
      const Surface surface = makeSurface(world_, hit, ray.direction);
      coverage = surface.point.coverage;
      radiance = scattered(surface, ray.direction, depth, weight * through * coverage);
      emitted = surface.emitted();
    }
    if (largest(emitted) > 0) radiance += emitted * emissionWeight(hit, ray.direction, travelled, rough);
    if (world_.attenuates()) {
      const bool front = glm::dot(hit.ng, ray.direction) <= 0;
      radiance *= inside_.transmittance(world_, hit.object, front, travelled);
    }
    sum += radiance * (through * coverage);
    through *= 1 - coverage;
    if (!(through > 0)) break;
    ray = makeSurface(world_, hit, ray.direction).leave(ray.direction);
    met = world_.intersect(ray, hit, counters_);
  }
  if (!met) sum += environment(ray.direction, rough) * through;
  return sum;
}

Vec3 Walk::scattered(const Surface& surface, const Vec3& direction, int depth, float weight) {
  if (!surface.scatters()) return Vec3(0);
  if (surface.material->unlit) return surface.point.baseColor;
  const Bsdf bsdf(surface, -direction);
  Vec3 radiance(0);
  if (bsdf.hasDiffuse()) {
    radiance = bsdf.diffuseUnderMap() * mapIrradiance(world_, surface);
  }
  return radiance + specular(surface, bsdf, depth, weight);
}

Vec3 Walk::specular(const Surface& surface, const Bsdf& bsdf, int depth, float weight) {
  if (!bsdf.hasSpecular()) return Vec3(0);
  float compensation = 1;
  if (depth > 0 && weight < kRouletteWeight) {
    const float survival = weight / kRouletteWeight;
    if (!(sampler_.next1D() < survival)) return Vec3(0);
    compensation = 1 / survival;
    weight = kRouletteWeight;
  }
  const bool splits = world_.disperses() && surface.disperses();
  return (splits ? dispersed(surface, bsdf, depth, weight) : branches(surface, bsdf, depth, weight)) *
         compensation;
}

Vec3 Walk::branches(const Surface& surface, const Bsdf& bsdf, int depth, float weight) {
  if (bsdf.layered()) return layeredBranches(surface, bsdf, depth, weight);
  if (bsdf.delta()) return deltaBranches(surface, bsdf, depth, weight);
  return roughRays(surface, bsdf, kLobeSpecular, depth, weight);
}

/// The first solid that splits light is followed for each channel, with the same random numbers; deeper ones,
/// met first after kSplitDepth, for one drawn channel. From there on all solids have that channel's index.
Vec3 Walk::dispersed(const Surface& surface, const Bsdf& bsdf, int depth, float weight) {
  const auto follow = [&](int channel) {
    Bsdf one = bsdf;
    one.setIor(surface.iorOf(channel));
    return branches(surface, one, depth, weight);
  };
  if (channel_ >= 0) return follow(channel_);
  Vec3 sum(0);
  if (depth < kSplitDepth) {
    const core::PixelSampler before = sampler_;
    for (channel_ = 0; channel_ < 3; ++channel_) {
      sampler_ = before;
      sum[channel_] = follow(channel_)[channel_];
    }
  } else {
    channel_ = std::min(2, static_cast<int>(3 * sampler_.next1D()));
    sum = heroOf(follow(channel_), channel_);
  }
  channel_ = -1;
  return sum;
}

Vec3 Walk::branch(const Surface& surface, const BsdfSample& s, float chance, int depth, float weight) {
  const Following following(*this, surface, s.direction);
  const Vec3 factor = s.weight / chance;
  return factor * incoming(surface.leave(s.direction), depth + 1, weight * largest(factor));
}

/// A smooth coat, a smooth base and the rough lobes: all followed at the first hits, later one of them.
Vec3 Walk::layeredBranches(const Surface& surface, const Bsdf& bsdf, int depth, float weight) {
  const std::optional<BsdfSample> coat = bsdf.coatReflection();
  const unsigned rough = bsdf.roughLobes();
  const float part[] = {coat ? largest(coat->weight) : 0, bsdf.delta() ? bsdf.estimate(kLobeBase) : 0,
                        bsdf.estimate(rough)};
  const auto follow = [&](int kind, float share) {
    if (kind == 0) return branch(surface, *coat, 1, depth, share);
    if (kind == 1) return deltaBranches(surface, bsdf, depth, share);
    return roughRays(surface, bsdf, rough, depth, share);
  };
  Vec3 sum(0);
  if (depth < kSplitDepth) {
    for (int kind = 0; kind < 3; ++kind) {
      if (part[kind] > 0) sum += follow(kind, weight);
    }
    return sum;
  }
  const float total = part[0] + part[1] + part[2];
  if (!(total > 0)) return sum;
  float at = sampler_.next1D() * total;
  int kind = 0;
  while (kind < 2 && at >= part[kind]) at -= part[kind++];
  if (!(part[kind] > 0)) return sum;  // rounding
  const float chance = part[kind] / total;
  return follow(kind, weight / chance) / chance;
}

Vec3 Walk::deltaBranches(const Surface& surface, const Bsdf& bsdf, int depth, float weight) {
  const BsdfSample reflection = bsdf.deltaReflection();
  const std::optional<BsdfSample> transmission = bsdf.deltaTransmission();
  const auto follow = [&](const BsdfSample& s, float chance) {
    return branch(surface, s, chance, depth, weight);
  };
  if (!transmission) return follow(reflection, 1);
  const float r = largest(reflection.weight), t = largest(transmission->weight);
  if (depth < kSplitDepth && weight * std::min(r, t) > kSplitWeight) {
    return follow(reflection, 1) + follow(*transmission, 1);
  }
  const float chance = r / (r + t);
  return sampler_.next1D() < chance ? follow(reflection, chance) : follow(*transmission, 1 - chance);
}

/// The rays of a rough lobe, stratified along its sample's first dimension.
void Walk::drawEach(const Surface& surface, const Bsdf& bsdf, unsigned lobes, int count, bool lights,
                    Legs& legs) {
  const auto rays = static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    Vec2 u = sampler_.next2D();
    u.x = (static_cast<float>(i) + u.x) / rays;
    const float uLobe = bsdf.transmits() || bsdf.layered() ? sampler_.next1D() : 0;
    const std::optional<BsdfSample> s = bsdf.sample(uLobe, u, lobes);
    if (!s) continue;
    legs.add(surface.leave(s->direction), lights && !s->delta ? s->pdf * rays : 0.0f, s->weight / rays);
  }
}

/// The same of a lobe without branches, side by side: the same bits.
void Walk::drawTogether(const Surface& surface, const Bsdf& bsdf, int count, bool lights, Legs& legs) {
  const auto rays = static_cast<float>(count);
  static_assert(CorrectiveOptions::kMaxGlossyRays <= kLanes);
  Vec2 u[kLanes];
  sampler_.next2D(u, count);
  for (int i = 0; i < count; ++i) u[i].x = (static_cast<float>(i) + u[i].x) / rays;
  const BsdfLanes s = bsdf.sampleLanes(u);
  for (int i = 0; i < count; ++i) {
    if (!(s.side[i] > 0)) continue;
    legs.add(surface.leave(s.direction[i]), lights ? s.pdf[i] * rays : 0.0f, s.weight[i] / rays);
  }
}

Vec3 Walk::roughRays(const Surface& surface, const Bsdf& bsdf, unsigned lobes, int depth, float weight) {
  const int count = depth == 0 ? options_.glossyRays : 1;
  const auto rays = static_cast<float>(count);
  // Inside a solid every light is behind its wall; only rays that leave find it.
  const bool lights = (bsdf.alpha() >= kNarrowAlpha || world_.lights().hasPunctual()) &&
                      !world_.lights().empty() && (surface.front || !surface.closed);
  Legs legs;
  if (count > 1 && bsdf.plain()) {
    drawTogether(surface, bsdf, count, lights, legs);
  } else {
    drawEach(surface, bsdf, lobes, count, lights, legs);
  }
  const int sent = legs.size();
  for (int i = 0; i < sent; ++i) {
    send(legs[i]);
    if (i > 0) locate(legs[i - 1], depth + 1);
  }
  LightChoice choice;
  if (lights) choice = world_.lights().choose(surface.position);
  if (sent > 0) locate(legs[sent - 1], depth + 1);
  Vec3 sum(0);
  if (lights) sum = lightSample(surface, bsdf, lobes, choice, rays, weight);
  for (int i = 0; i < sent; ++i) {
    const Leg& leg = legs[i];
    const RoughRay rough{&choice, leg.density};
    const Following following(*this, surface, leg.ray.direction);
    sum += leg.factor *
           received(leg, depth + 1, weight * largest(leg.factor), leg.density > 0 ? &rough : nullptr);
  }
  return sum;
}

Vec3 Walk::lightSample(const Surface& surface, const Bsdf& bsdf, unsigned lobes, const LightChoice& choice,
                       float rays, float weight) {
  const float uLight = sampler_.next1D();
  const Vec2 u = sampler_.next2D();
  LightSample light;
  if (!world_.lights().sample(choice, uLight, u, light)) return Vec3(0);
  const Vec3 f = bsdf.eval(light.direction, lobes);
  if (!(largest(f) > 0)) return Vec3(0);
  const float mis = light.delta ? 1 : powerHeuristic(light.pdf, rays * bsdf.pdf(light.direction, lobes));
  Vec3 contribution = f * light.radiance * (mis / light.pdf);
  if (world_.attenuates()) {
    const Following following(*this, surface, light.direction);
    contribution *= inside_.transmittance(world_, light.distance);
  }
  const float seen = weight * largest(contribution);
  if (seen < kFaintLight) {
    const float survival = seen / kFaintLight;
    if (!(sampler_.next1D() < survival)) return Vec3(0);
    contribution /= survival;
  }
  return contribution * world_.transmittance(shadowRay(surface, light), counters_);
}

}  // namespace saccade::raytrace
