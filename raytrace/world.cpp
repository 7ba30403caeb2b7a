#include "raytrace/world.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "raytrace/duplicates.h"
#include "raytrace/lights.h"
#include "raytrace/ray_log.h"

namespace saccade::raytrace {
namespace {

/// Half a unit in the last place of 1, times the number of roundings between vertices, hit point, shifted
/// origin and Embree's own differences. Measured in tests/unit/raytrace/rays_test.cpp, 20,000 rays at 10 km:
/// 4,100 meet their own surface with 1, 114 with 2, none with 4; four times that for safety.
constexpr float kOffsetRoundings = 16;
constexpr float kHalfUlp = 0x1p-24f;

/// What Embree hands to the filters. `base` comes first: Embree knows only that.
struct Context {
  RTCIntersectContext base;
  bool ownTree = false;     ///< one object's tree: its duplicates of other objects' triangles count
  float transmittance = 1;  ///< of a shadow ray so far

  explicit Context(bool own = false) : ownTree(own) { rtcInitIntersectContext(&base); }
};

/// Per object, for the filters; objects without either need none.
struct FilterData {
  const World* world = nullptr;
  std::uint32_t object = 0;
  std::uint32_t firstTriangle = 0;
  bool alpha = false;
  std::vector<bool> duplicate;  ///< by triangle; empty when none
};

/// Alpha of the texel, factor and vertex colour.
float alphaAt(const World& world, std::uint32_t triangle, float u, float v) {
  const TriangleRecord& r = world.record(triangle);
  const CompiledMaterial& m = world.materialOf(r.object);
  float alpha = m.alpha;
  const core::Mesh& mesh = world.meshOf(r.object);
  const std::uint32_t* corner = &mesh.indices[3 * (triangle - world.firstTriangle(r.object))];
  if (m.baseColorTexture) {
    const bool second = m.baseColorTexture.uvSet == 1 && !mesh.uv1.empty();
    const Vec2 uv =
        second ? mesh.uv1[corner[0]] * (1 - u - v) + mesh.uv1[corner[1]] * u + mesh.uv1[corner[2]] * v
               : r.uv0[0] * (1 - u - v) + r.uv0[1] * u + r.uv0[2] * v;
    alpha *= m.baseColorTexture.sample(uv).w;
  }
  if (world.hasColors(r.object)) {
    alpha *=
        mesh.colors[corner[0]].w * (1 - u - v) + mesh.colors[corner[1]].w * u + mesh.colors[corner[2]].w * v;
  }
  return alpha;
}

/// Whether the hit is there at all: not a masked texel, not a duplicate.
bool isThere(const FilterData& data, const RTCFilterFunctionNArguments& args, float& alpha) {
  const std::uint32_t prim = RTCHitN_primID(args.hit, args.N, 0);
  const auto* context = reinterpret_cast<const Context*>(args.context);
  if (!data.duplicate.empty() && !context->ownTree && data.duplicate[prim]) return false;
  alpha = 1;
  if (!data.alpha) return true;
  const std::uint32_t triangle = data.firstTriangle + prim;
  alpha = alphaAt(*data.world, triangle, RTCHitN_u(args.hit, args.N, 0), RTCHitN_v(args.hit, args.N, 0));
  const CompiledMaterial& m = data.world->materialOf(data.object);
  return m.alphaMode != core::AlphaMode::mask || alpha >= m.alphaCutoff;
}

void filterIntersect(const RTCFilterFunctionNArguments* args) {
  float alpha = 1;
  if (!isThere(*static_cast<const FilterData*>(args->geometryUserPtr), *args, alpha)) args->valid[0] = 0;
}

void filterOccluded(const RTCFilterFunctionNArguments* args) {
  const auto& data = *static_cast<const FilterData*>(args->geometryUserPtr);
  float alpha = 1;
  if (!isThere(data, *args, alpha)) {
    args->valid[0] = 0;
    return;
  }
  if (data.world->materialOf(data.object).alphaMode != core::AlphaMode::blend) return;
  auto* context = reinterpret_cast<Context*>(args->context);
  context->transmittance *= 1 - std::clamp(alpha, 0.0f, 1.0f);
  if (context->transmittance > 0) args->valid[0] = 0;
}

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
  Vec3 point{0};
  std::uint32_t prim = RTC_INVALID_GEOMETRY_ID;
  Vec2 barycentric{0};
};

bool closestCallback(RTCPointQueryFunctionArguments* args) {
  auto& state = *static_cast<ClosestState*>(args->userPtr);
  const TriangleShape& s = state.shapes[args->primID];
  const Vec2 b = closestBarycentric(state.point, s.position[0], s.position[1], s.position[2]);
  const Vec3 q = s.position[0] * (1 - b.x - b.y) + s.position[1] * b.x + s.position[2] * b.y;
  const float distance = glm::length(q - state.point);
  if (!(distance < args->query->radius)) return false;
  args->query->radius = distance;
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

void fromEmbree(const RTCRayHit& rh, std::uint32_t object, std::uint32_t firstTriangle, Hit& hit) {
  hit.object = object;
  hit.triangle = firstTriangle + rh.hit.primID;
  hit.t = rh.ray.tfar;
  hit.u = rh.hit.u;
  hit.v = rh.hit.v;
  hit.ng = {rh.hit.Ng_x, rh.hit.Ng_y, rh.hit.Ng_z};
}

}  // namespace

struct World::Embree {
  RTCDevice device = nullptr;
  RTCScene world = nullptr;
  std::vector<RTCScene> own;  ///< by object; null for diffuse objects
  std::vector<std::unique_ptr<FilterData>> filters;

  ~Embree() {
    for (RTCScene s : own) {
      if (s) rtcReleaseScene(s);
    }
    if (world) rtcReleaseScene(world);
    if (device) rtcReleaseDevice(device);
  }
  RTCScene newScene() {
    RTCScene s = rtcNewScene(device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_MEDIUM);
    return s;
  }
  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw core::Error("Embree failed with error " + std::to_string(static_cast<int>(error)) +
                      (error == RTC_ERROR_OUT_OF_MEMORY ? " (out of memory: use a smaller scene)" : ""));
  }
};

World::World(const core::Scene& scene, const core::Plan& plan)
    : scene_(scene),
      recursionDepth_(plan.recursionDepth),
      attenuates_(plan.attenuation),
      disperses_(plan.dispersion),
      textures_(scene),
      embree_(std::make_unique<Embree>()) {
  materials_.reserve(scene.materials.size());
  for (const core::Material& m : scene.materials) materials_.push_back(compileMaterial(scene, m, textures_));
  for (const core::Object& o : scene.objects) materialOf_.push_back(static_cast<std::uint32_t>(o.material));
  buildRecords();
  lights_ = std::make_unique<Lights>(scene, *this);
  for (std::size_t i = 0; i < lights_->emissiveCount(); ++i) {
    records_[lights_->emissiveTriangle(i)].light = static_cast<std::int32_t>(i);
  }
  buildTrees();
}

World::~World() = default;

void World::buildRecords() {
  records_.reserve(scene_.triangleCount());
  shapes_.reserve(scene_.triangleCount());
  objectOfId_.assign(scene_.idCount() + 1, 0);
  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    const core::Object& object = scene_.objects[o];
    const core::Mesh& mesh = scene_.meshOf(object);
    firstTriangle_.push_back(static_cast<std::uint32_t>(records_.size()));
    flags_.push_back(static_cast<std::uint8_t>(
        (object.closed && !scene_.materials[object.material].thinWalled ? kClosed : 0) |
        (object.id == 0 ? kDiffuse : 0) | (mesh.colors.empty() ? 0 : kColors)));
    if (object.id > 0) objectOfId_[object.id] = o;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      TriangleRecord r;
      TriangleShape s;
      float largest = 0;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t i = mesh.indices[3 * t + k];
        s.position[k] = mesh.positions[i];
        if (!mesh.normals.empty()) s.normal.set(k, mesh.normals[i]);
        if (!mesh.uv0.empty()) r.uv0[k] = mesh.uv0[i];
        if (!mesh.lightmapUv.empty()) r.lightmapUv[k] = mesh.lightmapUv[i];
        const Vec3 a = glm::abs(s.position[k]);
        largest = std::max({largest, a.x, a.y, a.z});
      }
      r.object = o;
      r.offset = largest * (kOffsetRoundings * kHalfUlp);
      records_.push_back(r);
      shapes_.push_back(s);
    }
  }
  firstTriangle_.push_back(static_cast<std::uint32_t>(records_.size()));
}

void World::buildTrees() {
  // One build thread: the tree, and with it the choice between equal distances, is the same on every machine.
  embree_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (!embree_->device) throw core::Error("Embree cannot be started: check that libembree3 is installed");
  embree_->world = embree_->newScene();
  embree_->own.assign(scene_.objects.size(), nullptr);
  const std::vector<bool> duplicate = findDuplicates(shapes_);

  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    const core::Mesh& mesh = meshOf(o);
    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangleCount()));
    embree_->check();
    if (vertices) std::copy_n(&mesh.positions[0].x, 3 * mesh.positions.size(), vertices);
    if (indices) std::copy_n(mesh.indices.data(), 3 * mesh.triangleCount(), indices);

    auto filter = std::make_unique<FilterData>();
    filter->world = this;
    filter->object = o;
    filter->firstTriangle = firstTriangle_[o];
    filter->alpha = materialOf(o).alphaMode != core::AlphaMode::opaque;
    const auto first = duplicate.begin() + firstTriangle_[o],
               last = duplicate.begin() + firstTriangle_[o + 1];
    if (std::find(first, last, true) != last) filter->duplicate.assign(first, last);
    if (filter->alpha || !filter->duplicate.empty()) {
      rtcSetGeometryUserData(geometry, filter.get());
      rtcSetGeometryIntersectFilterFunction(geometry, filterIntersect);
      rtcSetGeometryOccludedFilterFunction(geometry, filterOccluded);
      embree_->filters.push_back(std::move(filter));
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree_->world, geometry, o);
    if (!diffuse(o)) {
      embree_->own[o] = embree_->newScene();
      rtcAttachGeometryByID(embree_->own[o], geometry, 0);
      rtcCommitScene(embree_->own[o]);
    }
    rtcReleaseGeometry(geometry);
    embree_->check();
  }
  rtcCommitScene(embree_->world);
  embree_->check();
}

std::uint32_t World::objectOfId(std::uint32_t id) const {
  if (id == 0 || id >= objectOfId_.size()) {
    throw core::Error("no object has the ID " + std::to_string(id) +
                      ": frame and scene do not belong together");
  }
  return objectOfId_[id];
}

bool World::intersect(const Ray& ray, Hit& hit, RayCounters& counters) const {
  if (!traceable(ray)) {
    ++counters.refused;
    return false;
  }
  ++counters.rays;
  if (counters.log) counters.log->add(ray, -1, false);
  RTCRayHit rh = toRayHit(ray);
  Context context;
  rtcIntersect1(embree_->world, &context.base, &rh);
  if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  fromEmbree(rh, rh.hit.geomID, firstTriangle_[rh.hit.geomID], hit);
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
    if (!embree_->own[object] || !traceable(rest)) {
      ++counters.refused;
      return false;
    }
    ++counters.rays;
    if (counters.log) counters.log->add(rest, static_cast<std::int32_t>(object), false);
    RTCRayHit rh = toRayHit(rest);
    Context context(true);
    rtcIntersect1(embree_->own[object], &context.base, &rh);
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    fromEmbree(rh, object, firstTriangle_[object], hit);
    if (back || glm::dot(hit.ng, ray.direction) <= 0) return true;
    rest.tNear = std::nextafter(hit.t, core::kInfinity);
  }
}

bool World::closestPoint(std::uint32_t object, const Vec3& point, Hit& hit) const {
  if (!embree_->own[object] || !traceable({point, Vec3(1), 0, 1})) return false;
  ClosestState state;
  state.shapes = shapes_.data() + firstTriangle_[object];
  state.point = point;
  RTCPointQuery query;
  query.x = point.x;
  query.y = point.y;
  query.z = point.z;
  query.time = 0;
  query.radius = core::kInfinity;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->own[object], &query, &context, closestCallback, &state);
  if (state.prim == RTC_INVALID_GEOMETRY_ID) return false;
  const TriangleShape& s = state.shapes[state.prim];
  hit.triangle = firstTriangle_[object] + state.prim;
  hit.object = object;
  hit.t = 0;
  hit.u = state.barycentric.x;
  hit.v = state.barycentric.y;
  hit.ng = glm::cross(s.position[1] - s.position[0], s.position[2] - s.position[0]);
  return true;
}

float World::transmittance(const Ray& ray, RayCounters& counters) const {
  if (!traceable(ray)) {
    ++counters.refused;
    return 1;
  }
  ++counters.rays;
  if (counters.log) counters.log->add(ray, -1, true);
  RTCRay e = toEmbree(ray);
  Context context;
  rtcOccluded1(embree_->world, &context.base, &e);
  return e.tfar < 0 ? 0 : context.transmittance;
}

std::uint64_t replayRays(const World& world, const RayLog& log) {
  std::uint64_t hits = 0;
  for (const RayLog::Entry& entry : log.entries()) {
    Context context(entry.object >= 0);
    if (entry.occluded) {
      RTCRay e = toEmbree(entry.ray);
      rtcOccluded1(world.embree_->world, &context.base, &e);
      hits += e.tfar < 0;
    } else {
      RTCRayHit rh = toRayHit(entry.ray);
      rtcIntersect1(entry.object >= 0 ? world.embree_->own[entry.object] : world.embree_->world,
                    &context.base, &rh);
      hits += rh.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }
  return hits;
}

}  // namespace saccade::raytrace
