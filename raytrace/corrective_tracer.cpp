#include "raytrace/corrective_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/walk.h"

namespace saccade::raytrace {
namespace {

/// A point of the depth buffer that faces away is shaded as if seen this far above its horizon (a cosine).
constexpr float kGrazing = 0.01f;
/// Around a sample's point, of its distance, in which a ray to it must find its surface again.
constexpr float kRevisitReach = 1e-3f;
/// Pixels whose primary rays go one after another before any of them is shaded.
constexpr std::size_t kTogether = 16;

/// The direction under which a point from the depth buffer is shaded: it must face the eye.
Vec3 facingDirection(const Hit& hit, const Vec3& direction) {
  const float length = glm::length(hit.ng);
  if (!(length > 0)) return direction;
  const Vec3 ng = hit.ng / length;
  const float along = glm::dot(ng, direction);
  return along <= -kGrazing ? direction : glm::normalize(direction - ng * (along + kGrazing));
}

bool finite(const Vec3& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

}  // namespace

CorrectiveTracer::CorrectiveTracer(const World& world, const CorrectiveOptions& options)
    : world_(world), options_(options) {
  options_.samplesPerPixel = std::max(1, options.samplesPerPixel);
  options_.glossyRays = std::clamp(options.glossyRays, 1, CorrectiveOptions::kMaxGlossyRays);
}

/// The pixel's ray on the object that the frame names; where it misses, the object's point nearest to the
/// depth buffer's (design fact 9).
CorrectiveTracer::Primary CorrectiveTracer::aim(const core::FrameSnapshot& frame, int x, int y,
                                                RayCounters& counters) const {
  Primary primary;
  const std::uint32_t object = world_.objectOfId(frame.idAt(x, y));
  const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const Vec3 direction = frame.view.direction(center);
  const Ray ray{frame.view.camera().eye, direction, 0, core::kInfinity};
  primary.direction = glm::normalize(direction);
  primary.found = world_.intersectVisible(object, ray, primary.hit, counters);
  if (!primary.found) {
    primary.fromDepth = true;
    const float depth = frame.depth[frame.index(x, y)];
    primary.found = world_.closestPoint(object, frame.view.unproject(center, depth), primary.hit);
    if (primary.found) primary.direction = facingDirection(primary.hit, primary.direction);
  }
  return primary;
}

core::Sample CorrectiveTracer::trace(const core::FrameSnapshot& frame, int x, int y, int level,
                                     RayCounters& counters) const {
  return shade(frame, x, y, aim(frame, x, y, counters), level, counters);
}

void CorrectiveTracer::trace(const core::FrameSnapshot& frame, std::span<const core::Pixel> pixels, int level,
                             RayCounters& counters, std::vector<core::Sample>& samples) const {
  std::array<Primary, kTogether> primaries;
  while (!pixels.empty()) {
    const auto now = pixels.first(std::min(pixels.size(), kTogether));
    for (std::size_t i = 0; i < now.size(); ++i) {
      __builtin_prefetch(&frame.depth[frame.index(now[i].x, now[i].y)]);
      primaries[i] = aim(frame, now[i].x, now[i].y, counters);
      if (primaries[i].found) world_.prefetch(primaries[i].hit);
    }
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (primaries[i].found) prefetchSurface(world_, primaries[i].hit);
    }
    for (std::size_t i = 0; i < now.size(); ++i) {
      samples.push_back(shade(frame, now[i].x, now[i].y, primaries[i], level, counters));
    }
    pixels = pixels.subspan(now.size());
  }
}

core::Sample CorrectiveTracer::shade(const core::FrameSnapshot& frame, int x, int y, const Primary& primary,
                                     int level, RayCounters& counters) const {
  const Vec3& direction = primary.direction;
  core::Sample sample;
  sample.x = x;
  sample.y = y;
  sample.id = frame.idAt(x, y);
  sample.level = static_cast<std::uint8_t>(level);
  sample.fromDepth = primary.fromDepth;
  const float windowDepth = frame.depth[frame.index(x, y)];
  if (!primary.found) {
    const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    sample.position = frame.view.unproject(center, windowDepth);
    sample.normal = sample.toEye = -direction;
    sample.cosView = 1;
    sample.viewDepth = frame.view.viewDepth(windowDepth);
    return sample;
  }
  const Surface surface = makeSurface(world_, primary.hit, direction);
  const Bsdf bsdf(surface, -direction);
  sample.position = surface.position;
  sample.normal = surface.ns;
  sample.toEye = glm::normalize(frame.view.camera().eye - sample.position);
  sample.cosView = std::clamp(glm::dot(surface.ns, -direction), 0.0f, 1.0f);
  sample.viewDepth = sample.fromDepth ? frame.view.viewDepth(windowDepth) : primary.hit.t;

  const Vec3 sum = difference(surface, bsdf, frame.view.camera().eye, direction, x, y, counters);
  if (finite(sum)) {
    sample.correction = sum;
  } else {
    ++counters.nonFinite;
  }
  return sample;
}

std::optional<CorrectiveTracer::Revisit> CorrectiveTracer::revisit(const core::Sample& sample,
                                                                   const Vec3& eye,
                                                                   RayCounters& counters) const {
  const Vec3 toPoint = sample.position - eye;
  const float distance = glm::length(toPoint);
  if (!(distance > 0) || !(glm::dot(sample.normal, toPoint) < 0)) return {};
  const Vec3 direction = toPoint / distance;
  // Only the neighbourhood of the point: other parts of the object may stand in the way.
  const float reach = kRevisitReach * distance;
  Hit hit;
  if (!world_.intersectVisible(world_.objectOfId(sample.id),
                               {eye, direction, distance - reach, distance + reach}, hit, counters))
    return {};
  const Surface surface = makeSurface(world_, hit, direction);
  const Bsdf bsdf(surface, -direction);
  const Vec3 sum = difference(surface, bsdf, eye, direction, sample.x, sample.y, counters);
  if (!finite(sum)) return {};
  return Revisit{sum, shown(surface)};
}

Vec3 CorrectiveTracer::difference(const Surface& surface, const Bsdf& bsdf, const Vec3& eye,
                                  const Vec3& direction, int x, int y, RayCounters& counters) const {
  const Vec3 sum = correction(surface, bsdf, direction, x, y, counters);
  if (!world_.attenuates() || surface.front || !surface.closed) return sum;
  // The camera is inside this solid, which tints what the base layer shows too.
  const Vec3 left =
      Inside().transmittance(world_, surface.object, false, glm::length(surface.position - eye));
  return left * sum - (Vec3(1) - left) * shown(surface);
}

Vec3 CorrectiveTracer::shown(const Surface& surface) const {
  if (!surface.scatters()) return Vec3(0);
  const Vec3 reflected = surface.material->unlit
                             ? surface.point.baseColor
                             : baseAlbedo(surface.point) * (1 / core::kPi) * mapIrradiance(world_, surface);
  return (surface.emitted() + reflected) * surface.point.coverage;
}

Vec3 CorrectiveTracer::correction(const Surface& surface, const Bsdf& bsdf, const Vec3& direction, int x,
                                  int y, RayCounters& counters) const {
  const float coverage = surface.point.coverage;
  Vec3 sum(0);
  for (int i = 0; i < options_.samplesPerPixel; ++i) {
    Walk walk(world_, options_,
              core::PixelSampler(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                 static_cast<std::uint64_t>(i), options_.seed),
              counters);
    if (coverage > 0 && !surface.material->unlit) sum += coverage * walk.specular(surface, bsdf, 0, coverage);
    if (coverage < 1) sum += (1 - coverage) * walk.incoming(surface.leave(direction), 1, 1 - coverage);
  }
  sum /= static_cast<float>(options_.samplesPerPixel);
  if (bsdf.hasDiffuse()) {
    // What the base layer shows of the Lambert lobe is view-independent; emission is the same in both.
    const Vec3 viewDependent = bsdf.diffuseUnderMap() - baseAlbedo(surface.point) * (1 / core::kPi);
    sum += viewDependent * mapIrradiance(world_, surface) * coverage;
  }
  return sum;
}

}  // namespace saccade::raytrace
