// Rays and point queries through Embree's trees.
#include <algorithm>
#include <cmath>

#include "raytrace/embree_scene.h"
#include "raytrace/ray_log.h"

namespace saccade::raytrace {
namespace {

/// Closest point of a triangle to p as barycentric (u, v) (Ericson, Real-Time Collision Detection, 5.1.5).
Vec2 closestBarycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const Vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 > 0 ? d1 / (d1 - d3) : 0.0f, 0};
  const Vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 > 0 ? d2 / (d2 - d6) : 0.0f};
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float sum = (d4 - d3) + (d5 - d6);
    const float w = sum > 0 ? (d4 - d3) / sum : 0.0f;
    return {1 - w, w};
  }
  const float total = va + vb + vc;
  return total > 0 ? Vec2(vb / total, vc / total) : Vec2(0);
}

struct ClosestState {
  const TriangleShape* shapes = nullptr;  ///< of the object
  const Instance* place = nullptr;
  Vec3 point{0};  ///< in the world
  float distance = core::kInfinity;
  std::uint32_t prim = RTC_INVALID_GEOMETRY_ID;
  Vec2 barycentric{0};
};

/// Rounding of a point and of a radius taken to a mesh.
constexpr float kQueryMargin = 1 + 0x1p-16f;

bool closestCallback(RTCPointQueryFunctionArguments* args) {
  auto& state = *static_cast<ClosestState*>(args->userPtr);
  const TriangleShape& s = state.shapes[args->primID];
  Vec3 p[3] = {s.position[0], s.position[1], s.position[2]};
  if (state.place) {
    for (Vec3& corner : p) corner = state.place->point(corner);
  }
  const Vec2 b = closestBarycentric(state.point, p[0], p[1], p[2]);
  const Vec3 q = p[0] * (1 - b.x - b.y) + p[1] * b.x + p[2] * b.y;
  const float distance = glm::length(q - state.point);
  if (!(distance < state.distance)) return false;
  state.distance = distance;
  // The query runs in the mesh's space, distances in the world's.
  args->query->radius = state.place ? distance * state.place->stretch * kQueryMargin : distance;
  state.prim = args->primID;
  state.barycentric = b;
  return true;
}

RTCRay toEmbree(const Ray& r) {
  RTCRay e;
  e.org_x = r.origin.x;
  e.org_y = r.origin.y;
  e.org_z = r.origin.z;
  e.tnear = r.tNear;
  e.dir_x = r.direction.x;
  e.dir_y = r.direction.y;
  e.dir_z = r.direction.z;
  e.time = 0;
  e.tfar = r.tFar;
  e.mask = ~0u;
  e.id = 0;
  e.flags = 0;
  return e;
}

RTCRayHit toRayHit(const Ray& r) {
  RTCRayHit rh;
  rh.ray = toEmbree(r);
  rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return rh;
}

void fromEmbree(const RTCRayHit& rh, std::uint32_t object, std::uint32_t firstTriangle, const Instance* place,
                Hit& hit) {
  hit.object = object;
  hit.triangle = firstTriangle + rh.hit.primID;
  hit.t = rh.ray.tfar;
  hit.u = rh.hit.u;
  hit.v = rh.hit.v;
  hit.ng = {rh.hit.Ng_x, rh.hit.Ng_y, rh.hit.Ng_z};
  if (place) hit.ng = place->normalToWorld * hit.ng;
}

}  // namespace

bool World::intersect(const Ray& ray, Hit& hit, RayCounters& counters) const {
  if (!traceable(ray)) {
    ++counters.refused;
    return false;
  }
  ++counters.rays;
  if (counters.log) counters.log->add(ray, -1, false);
  RTCRayHit rh = toRayHit(ray);
  TraceContext context;
  rtcIntersect1(embree_->world, &context.base, &rh);
  if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const bool instanced = rh.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const std::uint32_t object = instanced ? rh.hit.instID[0] : rh.hit.geomID;
  fromEmbree(rh, object, firstTriangle_[object], instanced ? instanceOf(object) : nullptr, hit);
  return true;
}

bool World::intersectVisible(const Ray& ray, Hit& hit, RayCounters& counters) const {
  Ray rest = ray;
  while (intersect(rest, hit, counters)) {
    if (glm::dot(hit.ng, ray.direction) <= 0 || materialOf(hit.object).scattersBehind()) return true;
    rest.tNear = std::nextafter(hit.t, core::kInfinity);
  }
  return false;
}

bool World::intersectVisible(std::uint32_t object, const Ray& ray, Hit& hit, RayCounters& counters) const {
  Ray rest = ray;
  const bool back = materialOf(object).scattersBehind();
  while (true) {
    if (diffuse(object) || !traceable(rest)) {
      ++counters.refused;
      return false;
    }
    ++counters.rays;
    if (counters.log) counters.log->add(rest, static_cast<std::int32_t>(object), false);
    const Instance* place = instanceOf(object);
    RTCRayHit rh = toRayHit(place ? place->toMesh(rest) : rest);
    TraceContext context(object);
    rtcIntersect1(embree_->alone(scene_, object), &context.base, &rh);
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    fromEmbree(rh, object, firstTriangle_[object], place, hit);
    if (back || glm::dot(hit.ng, ray.direction) <= 0) return true;
    rest.tNear = std::nextafter(hit.t, core::kInfinity);
  }
}

bool World::closestPoint(std::uint32_t object, const Vec3& point, Hit& hit) const {
  if (diffuse(object) || !traceable({point, Vec3(1), 0, 1})) return false;
  ClosestState state;
  state.shapes = shapes_.data() + firstTriangle_[object];
  state.place = instanceOf(object);
  state.point = point;
  const Vec3 start = state.place ? state.place->toMesh({point}).origin : point;
  RTCPointQuery query;
  query.x = start.x;
  query.y = start.y;
  query.z = start.z;
  query.time = 0;
  query.radius = core::kInfinity;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->alone(scene_, object), &query, &context, closestCallback, &state);
  if (state.prim == RTC_INVALID_GEOMETRY_ID) return false;
  hit.triangle = firstTriangle_[object] + state.prim;
  hit.object = object;
  hit.t = 0;
  hit.u = state.barycentric.x;
  hit.v = state.barycentric.y;
  hit.ng = geometricNormal(object, hit.triangle);
  return true;
}

Vec3 World::geometricNormal(std::uint32_t object, std::uint32_t triangle) const {
  const TriangleShape& s = shapes_[triangle];
  const Vec3 cross = glm::cross(s.position[1] - s.position[0], s.position[2] - s.position[0]);
  const Instance* place = instanceOf(object);
  return place ? place->normalToWorld * cross : cross;
}

float World::transmittance(const Ray& ray, RayCounters& counters) const {
  if (!traceable(ray)) {
    ++counters.refused;
    return 1;
  }
  ++counters.rays;
  if (counters.log) counters.log->add(ray, -1, true);
  RTCRay e = toEmbree(ray);
  TraceContext context;
  rtcOccluded1(embree_->world, &context.base, &e);
  return e.tfar < 0 ? 0 : context.transmittance;
}

std::uint64_t replayRays(const World& world, const RayLog& log) {
  std::uint64_t hits = 0;
  for (const RayLog::Entry& entry : log.entries()) {
    if (entry.occluded) {
      TraceContext context;
      RTCRay e = toEmbree(entry.ray);
      rtcOccluded1(world.embree_->world, &context.base, &e);
      hits += e.tfar < 0;
      continue;
    }
    const auto object = static_cast<std::uint32_t>(entry.object);  // -1 is kNoObject
    const Instance* place = object == kNoObject ? nullptr : world.instanceOf(object);
    TraceContext context(object);
    RTCRayHit rh = toRayHit(place ? place->toMesh(entry.ray) : entry.ray);
    rtcIntersect1(object == kNoObject ? world.embree_->world : world.embree_->alone(world.scene_, object),
                  &context.base, &rh);
    hits += rh.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

}  // namespace saccade::raytrace
