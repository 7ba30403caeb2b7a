#include "raytrace/bake/gather.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "raytrace/bsdf.h"
#include "raytrace/medium.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

constexpr int kMaxEvents = 64;                    // surfaces met; a mirror box would not end otherwise
constexpr int kMostTries = 4;                     // samples drawn for one that is not covered
constexpr std::uint32_t kGatherStream = 0x6761u;  // keeps the random numbers apart from others'

constexpr std::uint32_t kNearStream = 0x6e656172u;

/// Bits of x and y in turn: neighbouring texels have neighbouring numbers, so that the samples of any patch
/// of texels lie about as evenly as those of one (Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of
/// Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", their z-order).
std::uint64_t mortonOf(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 16) & 0x0000ffff0000ffffull;
    v = (v | v << 8) & 0x00ff00ff00ff00ffull;
    v = (v | v << 4) & 0x0f0f0f0f0f0f0f0full;
    v = (v | v << 2) & 0x3333333333333333ull;
    return (v | v << 1) & 0x5555555555555555ull;
  };
  return spread(x) | spread(y) << 1;
}

/// Drawn by the cosine around `normal`; none where it lies below the surface.
std::optional<Vec3> cosineDirection(const Surface& from, const Vec3& normal, const Vec2& u) {
  const float sine = std::sqrt(u.x), angle = 2 * core::kPi * u.y, up = std::sqrt(std::max(0.0f, 1 - u.x));
  const Vec3 direction =
      glm::normalize(Frame(normal).toWorld({sine * std::cos(angle), sine * std::sin(angle), up}));
  if (!(glm::dot(direction, from.ng) > 0) || !(up > 0)) return std::nullopt;
  return direction;
}

/// One gather ray with all that follows from it.
class Gatherer {
 public:
  Gatherer(const World& world, const TexelMap& texels, const TexelLight& source, core::PixelSampler& random,
           RayCounters& counters)
      : world_(world), texels_(texels), source_(source), random_(random), counters_(counters) {}

  /// Irradiance by one ray drawn by the cosine around `normal`; 0 where that lies below the surface.
  Vec3 irradiance(const Surface& from, const Vec3& normal, const Vec2& u) {
    const std::optional<Vec3> direction = cosineDirection(from, normal, u);
    return direction ? along(from.leave(*direction)) : Vec3(0);
  }
  Vec3 along(const Ray& ray) {
    follow(ray);
    return sum_ * core::kPi;
  }

 private:
  void follow(Ray ray) {
    for (int event = 0; event < kMaxEvents; ++event) {
      Hit hit;
      if (!world_.intersect(ray, hit, counters_)) return;
      const Surface surface = makeSurface(world_, hit, ray.direction);
      if (world_.attenuates()) {
        throughput_ *= inside_.transmittance(world_, hit.object, surface.front, hit.t);
      }
      if (surface.point.coverage < 1 && random_.next1D() >= surface.point.coverage) {
        ray = surface.leave(ray.direction);
        continue;
      }
      if (!surface.scatters() || surface.material->unlit || !scatter(surface, ray)) return;
      if (world_.attenuates()) inside_.leave(surface, ray.direction);
    }
  }

  /// Adds what the diffuse lobe sends back and draws the next ray of the others; false where there is none.
  bool scatter(const Surface& surface, Ray& ray) {
    Bsdf bsdf(surface, -ray.direction);
    if (surface.disperses()) {
      if (channel_ < 0) {
        channel_ = std::min(2, static_cast<int>(3 * random_.next1D()));
        throughput_ = heroOf(throughput_, channel_);
      }
      bsdf.setIor(surface.iorOf(channel_));
    }
    if (bsdf.hasDiffuse()) sum_ += throughput_ * bsdf.diffuseUnderMap() * lightAt(surface);
    if (!bsdf.hasSpecular() && !bsdf.layered()) return false;
    const float uLobe = random_.next1D();
    const std::optional<BsdfSample> sample = bsdf.sample(uLobe, random_.next2D(), kLobeSpecular);
    const float uSurvive = random_.next1D();
    if (!sample) return false;
    const Vec3 next = throughput_ * sample->weight;
    const float survival = std::min(1.0f, largest(next));
    if (!(uSurvive < survival)) return false;
    throughput_ = next / survival;
    ray = surface.leave(sample->direction);
    return true;
  }

  Vec3 lightAt(const Surface& surface) const {
    const std::vector<Vec3>& layer = source_.layers[surface.front ? 0 : 1];
    if (layer.empty()) return Vec3(0);
    const Vec2& b = surface.barycentric;
    return layer[texels_.texelAt(world_.lightmapUv(surface.object, surface.triangle, b.x, b.y))];
  }

  const World& world_;
  const TexelMap& texels_;
  const TexelLight& source_;
  core::PixelSampler& random_;
  RayCounters& counters_;
  Vec3 sum_{0};
  Vec3 throughput_{1};
  int channel_ = -1;  ///< the only one followed, from the first solid that splits light
  Inside inside_;     ///< kept only where a solid attenuates
};

/// `covered`: some of it is.
DirectEstimate gatherTexel(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                           bool covered, const TexelLight& source, const GatherOptions& options) {
  RayCounters own;
  RayCounters& counters = options.counters ? *options.counters : own;
  const auto size = static_cast<std::size_t>(texels.size());
  const std::uint64_t first =
      mortonOf(static_cast<std::uint32_t>(texel % size), static_cast<std::uint32_t>(texel / size)) *
      static_cast<std::uint64_t>(options.rays);
  glm::dvec3 sum(0);
  double squares = 0;
  int count = 0;
  const int tries = covered ? kMostTries * options.rays : options.rays;
  for (int i = 0; i < tries && count < options.rays; ++i) {
    core::PixelSampler random(kGatherStream, static_cast<std::uint32_t>(layer),
                              first + static_cast<std::uint64_t>(i), options.seed);
    const Vec2 direction = random.next2D(), place = random.next2D();
    const MeshPoint at = texels.pointOn(texel, random.next1D(), place.x, place.y);
    const std::uint32_t triangle = world.firstTriangle(at.object) + at.triangle;
    const Surface from = surfaceOn(world, at.object, triangle, at.b1, at.b2, layer == 0);
    if (covered && isCovered(world, from, OpenArea::reach(texels, texel), counters)) continue;
    const Vec3 normal = smoothNormal(world, at.object, triangle, at.b1, at.b2, from.ng);
    const Vec3 e = Gatherer(world, texels, source, random, counters).irradiance(from, normal, direction);
    sum += e;
    squares += static_cast<double>(core::luminance(e)) * core::luminance(e);
    ++count;
  }
  if (count == 0) return {};
  const double n = count, mean = core::luminance(Vec3(sum)) / n;
  return {Vec3(sum / n), static_cast<float>(std::max(0.0, squares / n - mean * mean) / n)};
}

}  // namespace

std::size_t gatherIrradiance(const World& world, const TexelMap& texels, const OpenArea& open, int layer,
                             BlockRange blocks, const TexelLight& source, const GatherOptions& options,
                             const core::Progress& progress, std::span<DirectEstimate> out) {
  return parallelTexels(options.threads, blocks, texels.texelCount(), progress, [&](std::size_t texel) {
    const float area = open.areas(layer)[texel];
    if (!(area > 0)) return;
    if (options.keptCharts && (*options.keptCharts)[static_cast<std::size_t>(texels.chartOf(texel))]) return;
    out[texel] = gatherTexel(world, texels, texel, layer, area < texels.area(texel), source, options);
  });
}

NearLight nearLight(const World& world, const TexelMap& texels, std::size_t texel, const TexelCell& cell,
                    int layer, float reach, const TexelLight& source, const GatherOptions& options) {
  RayCounters own;
  RayCounters& counters = options.counters ? *options.counters : own;
  const std::uint32_t stream = kNearStream + cell.number() + static_cast<std::uint32_t>(layer);
  NearLight out;
  glm::dvec3 sum(0);
  int count = 0, near = 0;
  for (int i = 0; i < kMostTries * options.rays && count < options.rays; ++i) {
    core::PixelSampler random(stream, static_cast<std::uint32_t>(texel), static_cast<std::uint64_t>(i),
                              options.seed);
    const Vec2 u = random.next2D(), place = random.next2D();
    const std::optional<MeshPoint> at = texels.pointIn(texel, cell, place);
    if (!at) continue;
    const std::uint32_t triangle = world.firstTriangle(at->object) + at->triangle;
    const Surface from = surfaceOn(world, at->object, triangle, at->b1, at->b2, layer == 0);
    const Vec3 normal = smoothNormal(world, at->object, triangle, at->b1, at->b2, from.ng);
    ++count;
    const std::optional<Vec3> direction = cosineDirection(from, normal, u);
    if (!direction) continue;
    Ray ray = from.leave(*direction);
    Hit hit;
    if (!world.intersect(ray, hit, counters) || hit.t > reach) continue;
    ++near;
    sum += Gatherer(world, texels, source, random, counters).along(ray);
  }
  if (count == 0) return out;
  out.irradiance = Vec3(sum / static_cast<double>(count));
  out.open = static_cast<float>(count - near) / static_cast<float>(count);
  return out;
}

}  // namespace saccade::raytrace
