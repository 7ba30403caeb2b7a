#include "raytrace/bake/direct.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bsdf.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

/// Every so many-th sample also sends a ray by the cosine, for lights so near that area sampling is noise.
constexpr std::uint32_t kCosineEvery = 4;
constexpr int kMaxSheets = 16;  // see-through surfaces that such a ray passes

/// What each coordinate of a texel's points is for.
enum Dimension : int { kLight, kLightU, kLightV, kPointU, kPointV, kPart, kCosineU, kCosineV, kDimensions };

/// The points of one texel: a Kronecker sequence (multiples of the powers of 1 / g, g the root of x^9 = x +
/// 1), shifted at random by texel. The integrand is smooth in all dimensions at once in most texels, where
/// padded pairs of a (0, 2)-sequence are even in each pair only.
class TexelSampler {
 public:
  TexelSampler(std::size_t texel, int layer, std::uint32_t seed) {
    for (std::uint32_t d = 0; d < kDimensions; ++d) {
      shift_[d] =
          core::hashKey(static_cast<std::uint32_t>(texel), static_cast<std::uint32_t>(layer), d, seed);
    }
  }
  /// Coordinate of point `index`, [0, 1).
  float at(std::uint32_t index, Dimension d) const {
    return static_cast<float>((shift_[d] + index * kStep[d]) >> 8) * 0x1p-24f;
  }
  Vec2 pair(std::uint32_t index, Dimension u, Dimension v) const { return {at(index, u), at(index, v)}; }
  /// Where the environment is sampled: far from smooth, with a sun in it, so even in this pair above all.
  Vec2 environment(std::uint32_t index) const {
    return core::PixelSampler(shift_[kLightU], shift_[kLightV], index, shift_[kLight]).next2D();
  }

 private:
  static constexpr std::uint32_t kStep[kDimensions] = {3958238938u, 3647910312u, 3361911662u, 3098335500u,
                                                       2855423889u, 2631556713u, 2425240877u, 2235100342u};
  std::uint32_t shift_[kDimensions];
};

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

/// A point of a texel as the light sees it.
struct Receiver {
  Surface surface;
  Vec3 normal;  ///< interpolated
  LightChoice choice;

  Receiver(const World& world, const MeshPoint& at, bool front)
      : surface(
            surfaceOn(world, at.object, world.firstTriangle(at.object) + at.triangle, at.b1, at.b2, front)),
        normal(smoothNormal(world, at.object, surface.triangle, at.b1, at.b2, surface.ng)),
        choice(world.lights().choose(surface.position)) {}

  /// Cosine against the interpolated normal; 0 below either horizon.
  float cosine(const Vec3& direction) const {
    return glm::dot(direction, surface.ng) > 0 ? std::max(0.0f, glm::dot(direction, normal)) : 0.0f;
  }
};

/// Power heuristic (Veach 1997) for the light samples, of which there are kCosineEvery times as many.
float lightWeight(float pdfLight, float pdfCosine) {
  const float l = pdfLight * kCosineEvery;
  return l * l / (l * l + pdfCosine * pdfCosine);
}

/// Shadow rays to the lights.
Vec3 sampleLights(const World& world, const Receiver& at, float uLight, const Vec2& u,
                  RayCounters& counters) {
  Vec3 sum(0);
  forEachLight(at.choice, uLight, [&](float place, float factor) {
    LightSample light;
    if (!world.lights().sample(at.choice, place, u, light)) return;
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

/// A shadow ray to the environment.
Vec3 sampleEnvironment(const World& world, const Receiver& at, const EnvironmentLight& environment,
                       const Vec2& u, RayCounters& counters) {
  const EnvironmentSample s = environment.sample(u);
  const float cosine = at.cosine(s.direction);
  if (!(cosine > 0) || !(s.pdf > 0)) return Vec3(0);
  const float free = world.transmittance(at.surface.leave(s.direction), counters);
  const float weight = lightWeight(s.pdf, glm::dot(s.direction, at.surface.ng) / core::kPi);
  return s.radiance * (cosine * free * weight / s.pdf);
}

/// A ray by the cosine that counts where it meets a light.
Vec3 sampleCosine(const World& world, const Receiver& at, const Vec2& u, RayCounters& counters) {
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
    if (world.record(hit.triangle).light >= 0) {
      const float distance = glm::length(met.position - at.surface.position);
      const float pdf = world.lights().pdf(at.choice, hit.triangle, direction, distance);
      const float weight = 1 - lightWeight(pdf, up / core::kPi);
      return met.emitted() * (met.point.coverage * free * weight * core::kPi * cosine / up);
    }
    free *= 1 - met.point.coverage;
    if (!(free > 0)) break;
    ray = met.leave(direction);
  }
  return Vec3(0);
}

/// One sample: a point of the texel, shadow rays to the lights and now and then a ray by the cosine.
Vec3 sampleDirect(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                  const TexelSampler& random, std::uint32_t index, RayCounters& counters) {
  const Vec2 uPoint = random.pair(index, kPointU, kPointV);
  const MeshPoint point = texels.pointOn(texel, random.at(index, kPart), uPoint.x, uPoint.y);
  const Receiver at(world, point, layer == 0);
  Vec3 sum =
      sampleLights(world, at, random.at(index, kLight), random.pair(index, kLightU, kLightV), counters);
  const EnvironmentLight* environment = world.lights().environment();
  if (environment) sum += sampleEnvironment(world, at, *environment, random.environment(index), counters);
  if (index % kCosineEvery == 0 && (world.lights().emissiveCount() > 0 || environment)) {
    sum += sampleCosine(world, at, random.pair(index, kCosineU, kCosineV), counters) *
           static_cast<float>(kCosineEvery);
  }
  return sum;
}

DirectEstimate integrateTexel(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                              const DirectOptions& options, RayCounters& counters) {
  const TexelSampler random(texel, layer, options.seed);
  glm::dvec3 sum(0);
  double squares = 0;
  int count = 0;
  const auto run = [&](int until) {
    for (; count < until; ++count) {
      const Vec3 e =
          sampleDirect(world, texels, texel, layer, random, static_cast<std::uint32_t>(count), counters);
      sum += e;
      squares += static_cast<double>(core::luminance(e)) * core::luminance(e);
    }
  };
  const auto varianceOfMean = [&] {
    const double mean = core::luminance(Vec3(sum)) / count;
    return std::max(0.0, squares / count - mean * mean) / count;
  };
  run(options.samples);
  const double tolerated = options.relativeError * core::luminance(Vec3(sum)) / count;
  if (varianceOfMean() > tolerated * tolerated) run(options.samples * options.refinement);
  return {Vec3(sum / static_cast<double>(count)), static_cast<float>(varianceOfMean())};
}

}  // namespace

std::size_t directIrradiance(const World& world, const TexelMap& texels, int layer, BlockRange blocks,
                             const DirectOptions& options, const core::Progress& progress,
                             std::span<DirectEstimate> out) {
  if (world.lights().empty()) return blocks.last;
  return parallelTexels(options.threads, blocks, texels.texelCount(), progress, [&](std::size_t texel) {
    const std::int32_t chart = texels.chartOf(texel);
    if (chart < 0 || !(texels.area(texel) > 0)) return;
    if (layer == 1 && !texels.charts()[static_cast<std::size_t>(chart)].doubleSided) return;
    RayCounters own;
    out[texel] =
        integrateTexel(world, texels, texel, layer, options, options.counters ? *options.counters : own);
  });
}

}  // namespace saccade::raytrace
