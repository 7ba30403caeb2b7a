#include "raytrace/bake/direct.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "raytrace/bake/particles.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

/// One sample: a point of the texel, a light, a shadow ray.
Vec3 sampleDirect(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                  core::PixelSampler random, RayCounters& counters) {
  const float uPart = random.next1D();
  const Vec2 uPoint = random.next2D();
  const float uLight = random.next1D();
  const Vec2 uOnLight = random.next2D();
  const MeshPoint at = texels.pointOn(texel, uPart, uPoint.x, uPoint.y);
  const std::uint32_t triangle = world.firstTriangle(at.object) + at.triangle;
  const Surface surface = surfaceOn(world, triangle, at.b1, at.b2, layer == 0);
  const Lights& lights = world.lights();
  LightSample light;
  if (!lights.sample(lights.choose(surface.position), uLight, uOnLight, light)) return Vec3(0);
  if (!(glm::dot(light.direction, surface.ng) > 0)) return Vec3(0);
  const float cosine = glm::dot(light.direction, smoothNormal(world, triangle, at.b1, at.b2, surface.ng));
  if (!(cosine > 0) || !(light.pdf > 0)) return Vec3(0);
  const float free = world.transmittance(shadowRay(surface, light), counters);
  return free > 0 ? light.radiance * (cosine * free / light.pdf) : Vec3(0);
}

Vec3 integrateTexel(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                    const DirectOptions& options, RayCounters& counters) {
  glm::dvec3 sum(0);
  double squares = 0;
  int count = 0;
  const auto run = [&](int until) {
    for (; count < until; ++count) {
      const core::PixelSampler random(static_cast<std::uint32_t>(texel), static_cast<std::uint32_t>(layer),
                                      static_cast<std::uint64_t>(count), options.seed);
      const Vec3 e = sampleDirect(world, texels, texel, layer, random, counters);
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
