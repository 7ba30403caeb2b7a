#include "raytrace/bake/few_lamps.h"

#include <cmath>

#include "raytrace/bake/polygon_light.h"

namespace saccade::raytrace {
namespace {

/// A lamp whose longest edge is shorter than this share of its distance is taken as its centre: relative
/// error below a thousandth.
constexpr float kFar = 0.04f;
/// Groups that were sent fewer rays have no seen share of their own.
constexpr int kFewRays = 3;

}  // namespace

bool FewLamps::serves(const World& world) {
  return world.lights().emissiveCount() + world.scene().lights.size() <= kMost;
}

FewLamps::FewLamps(const World& world) : world_(world) {
  addEmissive();
  addPunctual();
}

void FewLamps::addEmissive() {
  const Lights& lights = world_.lights();
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < lights.emissiveCount(); ++i) {
    Lamp lamp;
    lamp.triangle = lights.emissiveTriangle(i);
    const std::uint32_t object = world_.record(lamp.triangle).object;
    if (i > 0 && object != world_.record(lights.emissiveTriangle(i - 1)).object) ++group;
    lamp.group = group;
    const CompiledMaterial& material = world_.materialOf(object);
    const TriangleShape& shape = world_.shape(lamp.triangle);
    for (int k = 0; k < 3; ++k) {
      lamp.corner[k] = shape.position[k];
      lamp.longest = std::max(lamp.longest, glm::length(shape.position[(k + 1) % 3] - shape.position[k]));
    }
    const Vec3 cross = glm::cross(lamp.corner[1] - lamp.corner[0], lamp.corner[2] - lamp.corner[0]);
    lamp.area = 0.5f * glm::length(cross);
    lamp.normal = cross / (2 * lamp.area);
    lamp.doubleSided = material.doubleSided;
    lamp.textured = static_cast<bool>(material.emissionTexture);
    lamp.radiance = lamp.textured ? Vec3(lights.meanRadiance(i)) : material.emission;
    lamps_.push_back(lamp);
  }
}

void FewLamps::addPunctual() {
  std::uint32_t group = lamps_.empty() ? 0 : lamps_.back().group + 1;
  for (std::size_t i = 0; i < world_.scene().lights.size(); ++i) {
    Lamp lamp;
    lamp.light = static_cast<std::int32_t>(i);
    lamp.group = group++;
    lamps_.push_back(lamp);
  }
}

/// Irradiance of one lamp, all of it seen.
Vec3 FewLamps::unshadowed(const Lamp& lamp, const Receiver& at, const Vec3& origin) const {
  if (lamp.light >= 0) {
    LightSample light;
    if (!world_.lights().samplePunctual(static_cast<std::size_t>(lamp.light), origin, light)) return Vec3(0);
    return light.radiance * at.cosine(light.direction);
  }
  const float height = glm::dot(origin - lamp.corner[0], lamp.normal);
  if (!(lamp.doubleSided ? height != 0 : height > 0)) return Vec3(0);
  const Vec3 to = (lamp.corner[0] + lamp.corner[1] + lamp.corner[2]) / 3.0f - origin;
  const float squared = glm::dot(to, to), distance = std::sqrt(squared);
  if (lamp.longest < kFar * distance) {
    const float cosine = at.cosine(to / distance);
    return lamp.radiance * (cosine * std::fabs(height) * lamp.area / (squared * distance));
  }
  return lamp.radiance *
         projectedSolidAngle(aboveHorizons(lamp.corner, origin, at.surface.ng, at.normal), at.normal);
}

FewLamps::Way FewLamps::wayTo(const Lamp& lamp, const Receiver& at, const Vec3& origin, const Vec2& u,
                              float irradiance) const {
  Way way;
  if (lamp.light >= 0) {
    if (world_.lights().samplePunctual(static_cast<std::size_t>(lamp.light), origin, way.light))
      way.weight = 1;
    return way;
  }
  const Vec3 center = (lamp.corner[0] + lamp.corner[1] + lamp.corner[2]) / 3.0f;
  const float height = std::fabs(glm::dot(origin - lamp.corner[0], lamp.normal));
  const Vec3 e = lamp.corner[1] - lamp.corner[0], f = lamp.corner[2] - lamp.corner[0];
  if (lamp.longest < kFar * glm::length(center - origin)) {
    way.place = uniformTriangle(u);
    const Vec3 to = lamp.corner[0] + e * way.place.x + f * way.place.y - origin;
    way.light.distance = glm::length(to);
    way.light.direction = to / way.light.distance;
    const float perArea = height / (way.light.distance * way.light.distance * way.light.distance);
    way.weight =
        at.cosine(way.light.direction) * perArea * lamp.area * core::luminance(lamp.radiance) / irradiance;
    return way;
  }
  const SkyDirection sky =
      sampleSky(aboveHorizons(lamp.corner, origin, at.surface.ng, at.normal), at.normal, u);
  const float slope = std::fabs(glm::dot(sky.direction, lamp.normal));
  if (!(sky.weight > 0) || !(slope > 0)) return way;
  way.weight = sky.weight;
  way.light.direction = sky.direction;
  way.light.distance = height / slope;
  const Vec3 d = origin + sky.direction * way.light.distance - lamp.corner[0];
  way.place = {glm::dot(glm::cross(d, f), lamp.normal) / (2 * lamp.area),
               glm::dot(glm::cross(e, d), lamp.normal) / (2 * lamp.area)};
  return way;
}

/// Looks at all lamps from the point.
FewLamps::Draw FewLamps::drawHere(const Receiver& at, const Vec3& origin, float uLamp,
                                  LampTally& tally) const {
  float below[kMost + 1] = {};
  for (std::size_t i = 0; i < lamps_.size(); ++i) {
    const Vec3 e = unshadowed(lamps_[i], at, origin);
    const float y = core::luminance(e);
    below[i + 1] = below[i] + y;
    if (!(y > 0)) continue;
    tally.ofLamp_[i] += y;
    if (lamps_[i].textured) continue;
    LampTally::Group& group = tally.groups_[lamps_[i].group];
    group.unshadowed += e;
    group.squares += double{y} * y;
  }
  ++tally.wholePoints_;
  const float total = below[lamps_.size()];
  tally.atWholePoints_ += total;
  tally.squaresAtWholePoints_ += double{total} * total;
  if (!(total > 0) || !std::isfinite(total)) return {};
  const float target = std::min(uLamp, 0x1.fffffep-1f) * total;
  std::size_t drawn = 0;
  while (drawn + 1 < lamps_.size() && below[drawn + 1] <= target) ++drawn;
  return {drawn, below[drawn + 1] - below[drawn], total};
}

/// Looks at one lamp only: the points of a texel see much the same.
FewLamps::Draw FewLamps::drawAsBefore(const Receiver& at, const Vec3& origin, float uLamp,
                                      const LampTally& tally) const {
  double total = 0;
  for (std::size_t i = 0; i < lamps_.size(); ++i) total += tally.ofLamp_[i];
  if (!(total > 0) || !std::isfinite(total)) return {};
  const double target = std::min(uLamp, 0x1.fffffep-1f) * total;
  std::size_t drawn = 0;
  for (double below = tally.ofLamp_[0]; drawn + 1 < lamps_.size() && below <= target;)
    below += tally.ofLamp_[++drawn];
  const float irradiance = core::luminance(unshadowed(lamps_[drawn], at, origin));
  return {drawn, irradiance, irradiance * total / tally.ofLamp_[drawn]};
}

void FewLamps::sample(const Receiver& at, float uLamp, const Vec2& u, int wholePoints, RayCounters& counters,
                      LampTally& tally) const {
  const Vec3 origin = at.surface.position + at.surface.ng * at.surface.offset;  // never in a lamp's own plane
  const bool whole = tally.wholePoints_ < wholePoints || !tally.wholePointsAgree();
  const Draw draw = whole ? drawHere(at, origin, uLamp, tally) : drawAsBefore(at, origin, uLamp, tally);
  ++tally.count_;
  tally.groupCount_ = lamps_.empty() ? 0 : lamps_.back().group + 1;
  tally.atAll_ += draw.weight;
  if (!(draw.weight > 0) || !std::isfinite(draw.weight)) return;
  const Lamp& lamp = lamps_[draw.lamp];
  Way way = wayTo(lamp, at, origin, u, draw.irradiance);
  if (!(way.weight > 0) || !std::isfinite(way.weight)) return;
  const float free = world_.transmittance(shadowRay(origin, way.light), counters);
  if (!lamp.textured) {
    tally.groups_[lamp.group].add(draw.weight * way.weight, free);
    return;
  }
  const Vec3 radiance = emissionAt(world_, lamp.triangle, way.place.x, way.place.y);
  const Vec3 e =
      radiance / core::luminance(lamp.radiance) * static_cast<float>(draw.weight * way.weight * free);
  tally.textured_ += e;
  tally.texturedSquares_ += double{core::luminance(e)} * core::luminance(e);
}

/// Unshadowed light hardly varies over the points so far.
bool LampTally::wholePointsAgree() const {
  constexpr double kEven = 0.03;  // standard deviation over mean
  const double mean = atWholePoints_ / wholePoints_;
  return squaresAtWholePoints_ / wholePoints_ - mean * mean <= kEven * kEven * mean * mean;
}

void LampTally::Group::add(double weight, double free) {
  all += weight;
  seen += weight * free;
  all2 += weight * weight;
  allSeen += weight * weight * free;
  seen2 += weight * free * weight * free;
  ++rays;
}

void LampTally::Group::add(const Group& o) {
  all += o.all;
  seen += o.seen;
  all2 += o.all2;
  allSeen += o.allSeen;
  seen2 += o.seen2;
  rays += o.rays;
}

/// Of the quotient, to first order.
double LampTally::Group::shareVariance() const {
  if (rays < 2 || !(all > 0)) return 0;
  const double s = share();
  const double residual = std::max(0.0, seen2 - 2 * s * allSeen + s * s * all2);
  return residual / (all * all) * rays / (rays - 1);
}

LampTally::Result LampTally::result() const {
  Result out;
  if (count_ == 0) return out;
  const double n = wholePoints_;
  // What whole points say of each group, scaled to what all points say of their sum.
  const double scale = atWholePoints_ > 0 ? atAll_ / count_ / (atWholePoints_ / n) : 1;
  Group rest, whole;
  for (std::size_t g = 0; g < groupCount_; ++g) {
    whole.add(groups_[g]);
    if (groups_[g].rays < kFewRays) rest.add(groups_[g]);
  }
  if (rest.rays < kFewRays) rest = whole;
  const auto luminance = [](const glm::dvec3& c) { return double{core::luminance(Vec3(c))}; };
  double restUnshadowed = 0;
  for (std::size_t g = 0; g < groupCount_; ++g) {
    const Group& group = groups_[g];
    const double unshadowed = scale * luminance(group.unshadowed) / n;
    if (!(unshadowed > 0)) continue;
    const bool own = group.rays >= kFewRays;
    const double share = own ? group.share() : rest.share();
    out.irradiance += group.unshadowed * (scale * share / n);
    out.unshadowed += unshadowed;
    if (own) {
      out.variance += unshadowed * unshadowed * group.shareVariance();
    } else {
      restUnshadowed += unshadowed;
    }
    // Points of a texel lie evenly: the error of a step falls as n^-3/4 and faster where light is smooth.
    out.variance += share * share *
                    std::max(0.0, group.squares * scale * scale / n - unshadowed * unshadowed) /
                    (n * std::sqrt(n));
  }
  out.variance += restUnshadowed * restUnshadowed * rest.shareVariance();
  const double samples = count_;
  const glm::dvec3 textured = textured_ / samples;
  const double y = luminance(textured);
  out.irradiance += textured;
  out.unshadowed += y;
  out.variance += std::max(0.0, texturedSquares_ / samples - y * y) / samples;
  return out;
}

}  // namespace saccade::raytrace
