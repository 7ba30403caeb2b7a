#include "raytrace/bake/direct.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "raytrace/bake/particles.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

/// The points of one texel: a Kronecker sequence (multiples of powers of the inverse of the plastic number of
/// six dimensions, the root of x^7 = x + 1), shifted at random by texel. The integrand is smooth in all six
/// dimensions at once in most texels, where padded pairs of a (0, 2)-sequence are even in each pair only: at
/// 64 samples under a square light they had 2.4 times the error.
class TexelSampler {
 public:
  TexelSampler(std::size_t texel, int layer, std::uint32_t seed) {
    for (std::uint32_t d = 0; d < kDimensions; ++d) {
      shift_[d] =
          core::hashKey(static_cast<std::uint32_t>(texel), static_cast<std::uint32_t>(layer), d, seed);
    }
  }
  /// Coordinate `dimension` of point `index`, [0, 1).
  float at(std::uint32_t index, int dimension) const {
    return static_cast<float>((shift_[dimension] + index * kStep[dimension]) >> 8) * 0x1p-24f;
  }

 private:
  static constexpr std::uint32_t kDimensions = 6;
  static constexpr std::uint32_t kStep[kDimensions] = {3859688306u, 3468523226u, 3117001274u,
                                                       2801104767u, 2517223199u, 2262111973u};
  std::uint32_t shift_[kDimensions];
};

/// Calls visit(uLight, factor): numbers for Lights::sample and the factor its result is to be taken by, so
/// that the sum is an estimate of all lights. Few lights are all taken, at a place in each that uLight says.
/// Unused entries of `cumulative` are 0, so it falls where the groups end.
template <class Visit>
void forEachLight(const LightChoice& choice, float uLight, Visit&& visit) {
  constexpr int kAllOf = 4;
  const auto groups = std::find_if(choice.cumulative + 1, choice.cumulative + LightChoice::kFewGroups,
                                   [&](const float& c) { return c < *(&c - 1); });
  if (choice.byPower || groups - choice.cumulative > kAllOf) {
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

/// One sample: a point of the texel, and shadow rays to the lights.
Vec3 sampleDirect(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                  const TexelSampler& random, std::uint32_t index, RayCounters& counters) {
  const MeshPoint at = texels.pointOn(texel, random.at(index, 5), random.at(index, 3), random.at(index, 4));
  const std::uint32_t triangle = world.firstTriangle(at.object) + at.triangle;
  const Surface surface = surfaceOn(world, triangle, at.b1, at.b2, layer == 0);
  const Vec3 normal = smoothNormal(world, triangle, at.b1, at.b2, surface.ng);
  const Lights& lights = world.lights();
  const LightChoice choice = lights.choose(surface.position);
  Vec3 sum(0);
  forEachLight(choice, random.at(index, 0), [&](float uLight, float factor) {
    LightSample light;
    if (!lights.sample(choice, uLight, {random.at(index, 1), random.at(index, 2)}, light)) return;
    const float cosine = glm::dot(light.direction, normal);
    if (!(glm::dot(light.direction, surface.ng) > 0) || !(cosine > 0) || !(light.pdf > 0)) return;
    const float free = world.transmittance(shadowRay(surface, light), counters);
    if (free > 0) sum += light.radiance * (cosine * free * factor / light.pdf);
  });
  return sum;
}

Vec3 integrateTexel(const World& world, const TexelMap& texels, std::size_t texel, int layer,
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
  run(options.samples);
  const double mean = core::luminance(Vec3(sum)) / count;
  const double variance = std::max(0.0, squares / count - mean * mean) / count;
  if (variance > std::pow(options.relativeError * mean, 2.0)) run(options.samples * options.refinement);
  return Vec3(sum / static_cast<double>(count));
}

}  // namespace

void directIrradiance(const World& world, const TexelMap& texels, int layer, const DirectOptions& options,
                      const core::Progress& progress, ProgressShare share, std::span<Vec3> irradiance) {
  if (world.lights().empty()) return;
  const auto width = static_cast<std::size_t>(texels.size());
  parallelFor(options.threads, width, progress, share, [&](std::size_t row) {
    RayCounters counters;
    for (std::size_t texel = row * width; texel < (row + 1) * width; ++texel) {
      const std::int32_t chart = texels.chartOf(texel);
      if (chart < 0 || !(texels.area(texel) > 0)) continue;
      if (layer == 1 && !texels.charts()[static_cast<std::size_t>(chart)].doubleSided) continue;
      irradiance[texel] = integrateTexel(world, texels, texel, layer, options, counters);
    }
  });
}

}  // namespace saccade::raytrace
