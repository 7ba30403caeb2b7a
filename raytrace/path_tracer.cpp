#include "raytrace/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/math/random.h"
#include "raytrace/lights.h"
#include "raytrace/medium.h"
#include "raytrace/parallel_rows.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

constexpr int kRouletteBounces = 3;  ///< scattered so often before roulette begins
constexpr float kLargestSurvival = 0.95f;
constexpr int kMaxLayers = 256;  ///< blended layers that one path passes
/// Keeps the random numbers of points apart from those of pixels.
constexpr std::uint32_t kIrradianceStream = 0xffff'6900u;
/// Samples of a point lie evenly, so their spread says too much: the variance is that of so many independent
/// groups.
constexpr std::uint32_t kReplicates = 16;

float powerHeuristic(float a, float b) {
  const float a2 = a * a, b2 = b * b;
  return a2 > 0 ? a2 / (a2 + b2) : 0;
}

/// Unit, with a density of cosine / pi around the frame's normal.
Vec3 cosineDirection(const Frame& frame, const Vec2& u) {
  const float r = std::sqrt(u.x), phi = 2 * core::kPi * u.y;
  return glm::normalize(
      frame.toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u.x))}));
}

/// The material as the transport sees it: with Transport::diffuse only the base layer's Lambert lobe.
class Scatterer {
 public:
  Scatterer(const Surface& surface, const Vec3& toEye, const PathOptions& options, int channel)
      : full_(surface, toEye, options.diffuse),
        frame_(surface.ns),
        ng_(surface.ng),
        diffuseOnly_(options.transport == Transport::diffuse) {
    if (channel >= 0 && surface.disperses()) full_.setIor(surface.iorOf(channel));
    albedo_ = diffuseOnly_ && surface.scatters() ? baseAlbedo(surface.point) : Vec3(0);
  }
  /// Light sampling can contribute.
  bool takesLight() const {
    return diffuseOnly_ ? largest(albedo_) > 0 : full_.hasDiffuse() || full_.roughLobes() != 0;
  }
  Vec3 eval(const Vec3& wi) const {
    if (!diffuseOnly_) return full_.eval(wi, kLobeAll);
    return above(wi) ? albedo_ * (glm::dot(wi, frame_.n) / core::kPi) : Vec3(0);
  }
  float pdf(const Vec3& wi) const {
    if (!diffuseOnly_) return full_.pdf(wi, kLobeAll);
    return above(wi) ? glm::dot(wi, frame_.n) / core::kPi : 0;
  }
  std::optional<BsdfSample> sample(float uLobe, const Vec2& u) const {
    if (!diffuseOnly_) return full_.sample(uLobe, u, kLobeAll);
    BsdfSample s;
    s.direction = cosineDirection(frame_, u);
    if (!above(s.direction)) return std::nullopt;
    s.pdf = pdf(s.direction);
    s.weight = albedo_;
    return s;
  }

 private:
  bool above(const Vec3& wi) const { return glm::dot(wi, frame_.n) > 0 && glm::dot(wi, ng_) > 0; }
  Bsdf full_;
  Frame frame_;
  Vec3 ng_;
  Vec3 albedo_{0};
  bool diffuseOnly_;
};

/// A surface that takes light, as a white Lambert one under the interpolated normal.
class Receiver {
 public:
  Receiver(const Vec3& ng, const Vec3& normal) : ng_(ng), frame_(normal) {}
  static bool takesLight() { return true; }
  Vec3 eval(const Vec3& wi) const { return Vec3(pdf(wi)); }
  float pdf(const Vec3& wi) const { return above(wi) ? glm::dot(wi, frame_.n) / core::kPi : 0; }
  std::optional<BsdfSample> sample(float, const Vec2& u) const {
    BsdfSample s;
    s.direction = cosineDirection(frame_, u);
    if (!above(s.direction)) return std::nullopt;
    s.pdf = pdf(s.direction);
    s.weight = Vec3(1);
    return s;
  }

 private:
  bool above(const Vec3& wi) const { return glm::dot(wi, frame_.n) > 0 && glm::dot(wi, ng_) > 0; }
  Vec3 ng_;
  Frame frame_;
};

/// One path.
class Path {
 public:
  Path(const World& world, const PathOptions& options, core::PixelSampler& sampler, RayCounters& counters)
      : world_(world), options_(options), sampler_(sampler), counters_(counters) {}

  Vec3 radiance(const Ray& ray) {
    follow(ray, 0);
    return sum_;
  }

  /// Radiance times pi that a white Lambert surface would send back: irradiance against `normal`.
  Vec3 irradiance(const Surface& at, const Vec3& normal) {
    Ray ray;
    if (scatterBy(at, Receiver(at.ng, normal), ray)) follow(ray, 1);
    return sum_ * core::kPi;
  }

 private:
  /// `bounce`: scattering events before this ray.
  void follow(Ray ray, int bounce) {
    Hit hit;
    int layers = 0;
    while (true) {
      if (!(bounce == 0 ? world_.intersectVisible(ray, hit, counters_)
                        : world_.intersect(ray, hit, counters_))) {
        addEnvironment(ray.direction);
        break;
      }
      const Vec3 direction = ray.direction;
      travelled_ += hit.t;
      const Surface surface = makeSurface(world_, hit, direction);
      if (world_.attenuates()) throughput_ *= inside_.transmittance(world_, hit.object, surface.front, hit.t);
      if (surface.point.coverage < 1 && !(sampler_.next1D() < surface.point.coverage)) {
        if (++layers > kMaxLayers) break;
        ray = surface.leave(direction);
        continue;
      }
      sum_ += throughput_ * surface.emitted() * emissionWeight(hit, direction);
      if (surface.material->unlit) {
        if (surface.scatters()) sum_ += throughput_ * surface.point.baseColor;
        break;
      }
      if (!surface.scatters() || bounce >= options_.bounces) break;
      if (!scatter(surface, ray)) break;
      if (++bounce > kRouletteBounces && !survives()) break;
    }
  }

  float emissionWeight(const Hit& hit, const Vec3& direction) const {
    if (!(density_ > 0)) return 1;
    return powerHeuristic(density_, world_.lights().pdf(choice_, hit.triangle, direction, travelled_));
  }

  void addEnvironment(const Vec3& direction) {
    const EnvironmentLight* environment = world_.lights().environment();
    if (!environment) return;
    const float weight =
        density_ > 0 ? powerHeuristic(density_, world_.lights().environmentPdf(choice_, direction)) : 1.0f;
    sum_ += throughput_ * environment->radiance(direction) * weight;
  }

  /// Direct light by light sampling, then the next ray. False when the path ends.
  bool scatter(const Surface& surface, Ray& ray) {
    if (world_.disperses() && surface.disperses()) followOneChannel();
    return scatterBy(surface, Scatterer(surface, -ray.direction, options_, channel_), ray);
  }

  template <class Material>
  bool scatterBy(const Surface& surface, const Material& material, Ray& ray) {
    const bool lights = !world_.lights().empty() && material.takesLight();
    if (lights) {
      choice_ = world_.lights().choose(surface.position);
      sum_ += throughput_ * directLight(surface, material);
    }
    const float uLobe = sampler_.next1D();
    const std::optional<BsdfSample> s = material.sample(uLobe, sampler_.next2D());
    if (!s) return false;
    throughput_ *= s->weight;
    density_ = lights && !s->delta ? s->pdf : 0;
    travelled_ = 0;
    ray = surface.leave(s->direction);
    if (world_.attenuates()) inside_.leave(surface, s->direction);
    return largest(throughput_) > 0;
  }

  template <class Material>
  Vec3 directLight(const Surface& surface, const Material& material) {
    const float uLight = sampler_.next1D();
    const Vec2 u = sampler_.next2D();
    LightSample light;
    if (!world_.lights().sample(choice_, uLight, u, light)) return Vec3(0);
    const Vec3 f = material.eval(light.direction);
    if (!(largest(f) > 0)) return Vec3(0);
    const float mis = light.delta ? 1 : powerHeuristic(light.pdf, material.pdf(light.direction));
    const float free = world_.transmittance(shadowRay(surface, light), counters_);
    return f * light.radiance * (mis * free / light.pdf) * mediumTowards(surface, light);
  }

  /// What the solid around the light's way leaves of it: lamps inside glass.
  Vec3 mediumTowards(const Surface& surface, const LightSample& light) const {
    if (!world_.attenuates()) return Vec3(1);
    Inside inside = inside_;
    inside.leave(surface, light.direction);
    return inside.transmittance(world_, light.distance);
  }

  /// The first solid that splits light leaves the path one channel, drawn once.
  void followOneChannel() {
    if (channel_ >= 0) return;
    channel_ = std::min(2, static_cast<int>(3 * sampler_.next1D()));
    throughput_ = heroOf(throughput_, channel_);
  }

  bool survives() {
    const float survival = std::min(kLargestSurvival, largest(throughput_));
    if (!(sampler_.next1D() < survival)) return false;
    throughput_ /= survival;
    return true;
  }

  const World& world_;
  const PathOptions& options_;
  core::PixelSampler& sampler_;
  RayCounters& counters_;
  Vec3 sum_{0};
  Vec3 throughput_{1};
  int channel_ = -1;     ///< the only one followed; -1: all
  Inside inside_;        ///< kept only where a solid attenuates
  LightChoice choice_;   ///< at the last rough scattering
  float density_ = 0;    ///< of the present ray, 0 = the lights were not sampled where it began
  float travelled_ = 0;  ///< since then, through blended layers
};

/// Running mean and variance of a pixel, in double.
struct Moments {
  glm::dvec3 sum{0}, squares{0};
  void add(const Vec3& c) {
    const glm::dvec3 d(c);
    sum += d;
    squares += d * d;
  }
  Vec3 mean(int n) const { return Vec3(sum / static_cast<double>(n)); }
  Vec3 varianceOfMean(int n) const {
    if (n < 2) return Vec3(0);
    const double count = n;
    return Vec3(glm::max(glm::dvec3(0), squares - sum * sum / count) / (count * (count - 1)));
  }
};

/// A point that takes light, and the normal that it takes it against.
struct Receiving {
  Surface surface;
  Vec3 normal;

  Receiving(const World& world, const SurfacePoint& at)
      : surface(surfaceOn(world, at.object, world.firstTriangle(at.object) + at.triangle, at.b1, at.b2,
                          at.front)),
        normal(smoothNormal(world, at.object, surface.triangle, at.b1, at.b2, surface.ng)) {}
};

bool finite(const Vec3& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

void addSample(const Vec3& c, RayCounters& counters, Moments& moments) {
  if (finite(c)) {
    moments.add(c);
  } else {
    ++counters.nonFinite;
  }
}

}  // namespace

PathResult tracePaths(const World& world, const core::View& view, const PathOptions& options,
                      const core::Progress& progress) {
  PathResult result;
  const int n = std::max(1, options.samplesPerPixel);
  result.radiance = core::ImageRgb(view.width(), view.height());
  if (options.variance) result.variance = core::ImageRgb(view.width(), view.height());
  std::vector<RayCounters> counters(std::max(1, options.threads));
  parallelRows(view.height(), options.threads, progress, [&](int y, int worker) {
    RayCounters tally;
    for (int x = 0; x < view.width(); ++x) {
      if (progress.stop.stop_requested()) throw core::Error("stopped on request");
      Moments moments;
      for (int i = 0; i < n; ++i) {
        core::PixelSampler sampler(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                   options.firstSample + static_cast<std::uint64_t>(i), options.seed);
        const Vec2 jitter = sampler.next2D();
        const Vec2 pixel(static_cast<float>(x) + jitter.x, static_cast<float>(y) + jitter.y);
        const Ray ray{view.camera().eye, glm::normalize(view.direction(pixel)), 0, core::kInfinity};
        addSample(Path(world, options, sampler, tally).radiance(ray), tally, moments);
      }
      result.radiance.at(x, y) = moments.mean(n);
      if (options.variance) result.variance.at(x, y) = moments.varianceOfMean(n);
    }
    counters[worker].add(tally);
  });
  for (const RayCounters& c : counters) result.counters.add(c);
  return result;
}

Vec3 pathRadiance(const World& world, const Ray& ray, const PathOptions& options, RayCounters& counters) {
  Moments moments;
  const int n = std::max(1, options.samplesPerPixel);
  for (int i = 0; i < n; ++i) {
    core::PixelSampler sampler(0, 0, options.firstSample + static_cast<std::uint64_t>(i), options.seed);
    addSample(Path(world, options, sampler, counters).radiance(ray), counters, moments);
  }
  return moments.mean(n);
}

Vec3 irradiancePath(const World& world, const SurfacePoint& at, std::uint32_t stream,
                    const PathOptions& options, RayCounters& counters) {
  const Receiving point(world, at);
  core::PixelSampler sampler(stream, kIrradianceStream + kReplicates, options.firstSample, options.seed);
  const Vec3 e = Path(world, options, sampler, counters).irradiance(point.surface, point.normal);
  if (finite(e)) return e;
  ++counters.nonFinite;
  return Vec3(0);
}

IrradianceEstimate pathIrradiance(const World& world, const SurfacePoint& at, std::uint32_t stream,
                                  const PathOptions& options, RayCounters& counters) {
  const Receiving point(world, at);
  Moments means;
  const int each = (std::max(1, options.samplesPerPixel) + kReplicates - 1) / kReplicates;
  for (std::uint32_t r = 0; r < kReplicates; ++r) {
    Moments moments;
    for (int i = 0; i < each; ++i) {
      core::PixelSampler sampler(stream, kIrradianceStream + r,
                                 options.firstSample + static_cast<std::uint64_t>(i), options.seed);
      addSample(Path(world, options, sampler, counters).irradiance(point.surface, point.normal), counters,
                moments);
    }
    means.add(moments.mean(each));
  }
  return {means.mean(kReplicates), means.varianceOfMean(kReplicates)};
}

}  // namespace saccade::raytrace
