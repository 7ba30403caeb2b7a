// Embree's trees, and the filters that leave out what is not there.
#include <algorithm>
#include <chrono>

#include "raytrace/duplicates.h"
#include "raytrace/embree_scene.h"

namespace saccade::raytrace {
namespace {

/// Alpha of the texel, factor and vertex colour.
float alphaAt(const World& world, std::uint32_t object, std::uint32_t triangle, float u, float v) {
  const TriangleRecord& r = world.record(triangle);
  const CompiledMaterial& m = world.materialOf(object);
  float alpha = m.alpha;
  const core::Mesh& mesh = world.meshOf(object);
  const std::uint32_t* corner = &mesh.indices[3 * (triangle - world.firstTriangle(object))];
  if (m.baseColorTexture) {
    const bool second = m.baseColorTexture.uvSet == 1 && !mesh.uv1.empty();
    const Vec2 uv =
        second ? mesh.uv1[corner[0]] * (1 - u - v) + mesh.uv1[corner[1]] * u + mesh.uv1[corner[2]] * v
               : r.uv0[0] * (1 - u - v) + r.uv0[1] * u + r.uv0[2] * v;
    alpha *= m.baseColorTexture.sample(uv).w;
  }
  if (world.hasColors(object)) {
    alpha *=
        mesh.colors[corner[0]].w * (1 - u - v) + mesh.colors[corner[1]].w * u + mesh.colors[corner[2]].w * v;
  }
  return alpha;
}

std::uint32_t objectOf(const FilterData& data, const TraceContext& context) {
  if (data.object != kNoObject) return data.object;
  return context.alone != kNoObject ? context.alone : context.base.instID[0];
}

/// Whether the hit is there at all: not a masked texel, not a duplicate.
bool isThere(const FilterData& data, const RTCFilterFunctionNArguments& args, float& alpha) {
  const std::uint32_t prim = RTCHitN_primID(args.hit, args.N, 0);
  const auto* context = reinterpret_cast<const TraceContext*>(args.context);
  if (!data.duplicate.empty() && context->alone == kNoObject && data.duplicate[prim]) return false;
  alpha = 1;
  if (!data.alpha) return true;
  const std::uint32_t object = objectOf(data, *context);
  const CompiledMaterial& m = data.world->materialOf(object);
  if (m.alphaMode == core::AlphaMode::opaque) return true;
  alpha = alphaAt(*data.world, object, data.firstTriangle + prim, RTCHitN_u(args.hit, args.N, 0),
                  RTCHitN_v(args.hit, args.N, 0));
  return m.alphaMode != core::AlphaMode::mask || alpha >= m.alphaCutoff;
}

}  // namespace

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
  if (!data.alpha) return;
  auto* context = reinterpret_cast<TraceContext*>(args->context);
  if (data.world->materialOf(objectOf(data, *context)).alphaMode != core::AlphaMode::blend) return;
  context->transmittance *= 1 - std::clamp(alpha, 0.0f, 1.0f);
  if (context->transmittance > 0) args->valid[0] = 0;
}

namespace {

RTCGeometry newTriangles(RTCDevice device, const core::Mesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangleCount()));
  if (vertices) std::copy_n(&mesh.positions[0].x, 3 * mesh.positions.size(), vertices);
  if (indices) std::copy_n(mesh.indices.data(), 3 * mesh.triangleCount(), indices);
  return geometry;
}

RTCGeometry newInstance(RTCDevice device, RTCScene mesh, const Instance& place) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh);
  float columns[12];
  for (int c = 0; c < 4; ++c) {
    const Vec3& column = c < 3 ? place.linear[c] : place.translation;
    for (int r = 0; r < 3; ++r) columns[3 * c + r] = column[r];
  }
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(geometry);
  return geometry;
}

bool countBytes(void* counter, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::int64_t>*>(counter) += bytes;
  return true;
}

}  // namespace

/// Puts the scene into Embree.
class TreeBuilder {
 public:
  TreeBuilder(const World& world, World::Embree& embree, const core::Progress& progress)
      : world_(world),
        scene_(world.scene()),
        e_(embree),
        progress_(progress),
        duplicate_(findDuplicates(world.shapes_)) {
    e_.own.assign(scene_.objects.size(), nullptr);
    e_.meshes.assign(scene_.meshes.size(), nullptr);
    alphaOfMesh_.assign(scene_.meshes.size(), 0);
    for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
      alphaOfMesh_[scene_.objects[o].mesh] |= world.materialOf(o).alphaMode != core::AlphaMode::opaque;
    }
    hidden_.assign(scene_.objects.size(), 0);
    for (const Twin& t : world.twins_) hidden_[t.object] = 1;
  }

  void build() {
    e_.world = e_.newScene();
    for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
      RTCGeometry geometry = world_.instanceOf(o) ? instance(o) : triangles(o);
      if (!world_.instanceOf(o) && !world_.diffuse(o)) e_.own[o] = sceneOf(geometry);
      if (!hidden_[o]) rtcAttachGeometryByID(e_.world, geometry, o);
      rtcReleaseGeometry(geometry);
      e_.check();
    }
    buildsWorld_ = true;
    commit(e_.world);
    e_.check();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto kReportEvery = std::chrono::milliseconds(50);

  void commit(RTCScene scene) {
    rtcSetSceneProgressMonitorFunction(scene, goOn, this);
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);  // the scene outlives this builder
  }

  /// Embree's progress monitor: false ends the build with RTC_ERROR_CANCELLED. One thread builds.
  static bool goOn(void* builder, double fraction) {
    auto& self = *static_cast<TreeBuilder*>(builder);
    const Clock::time_point now = Clock::now();
    if (self.buildsWorld_ && self.progress_.report && now - self.lastReport_ >= kReportEvery) {
      self.lastReport_ = now;
      self.progress_.report(std::min(fraction, 1.0));
    }
    return !self.progress_.stop.stop_requested();
  }

  /// The mesh of an object, with its filters.
  RTCGeometry triangles(std::uint32_t o) {
    RTCGeometry geometry = newTriangles(e_.device, world_.meshOf(o));
    e_.check();
    auto filter = std::make_unique<FilterData>();
    filter->world = &world_;
    filter->object = world_.instanceOf(o) ? kNoObject : o;
    filter->firstTriangle = world_.firstTriangle(o);
    filter->alpha = alphaOfMesh_[scene_.objects[o].mesh] != 0;
    const auto first = duplicate_.begin() + world_.firstTriangle(o), last = first + world_.triangleCountOf(o);
    if (std::find(first, last, true) != last) filter->duplicate.assign(first, last);
    if (filter->alpha || !filter->duplicate.empty()) {
      rtcSetGeometryUserData(geometry, filter.get());
      rtcSetGeometryIntersectFilterFunction(geometry, filterIntersect);
      rtcSetGeometryOccludedFilterFunction(geometry, filterOccluded);
      e_.filters.push_back(std::move(filter));
    }
    rtcCommitGeometry(geometry);
    return geometry;
  }

  RTCGeometry instance(std::uint32_t o) {
    RTCScene& mesh = e_.meshes[scene_.objects[o].mesh];
    if (!mesh) {
      RTCGeometry geometry = triangles(o);
      mesh = sceneOf(geometry);
      rtcReleaseGeometry(geometry);
    }
    return newInstance(e_.device, mesh, *world_.instanceOf(o));
  }

  RTCScene sceneOf(RTCGeometry geometry) {
    RTCScene scene = e_.newScene();
    rtcAttachGeometryByID(scene, geometry, 0);
    commit(scene);
    return scene;
  }

  const World& world_;
  const core::Scene& scene_;
  World::Embree& e_;
  const core::Progress& progress_;
  bool buildsWorld_ = false;  ///< the common tree is being built
  Clock::time_point lastReport_{};
  std::vector<bool> duplicate_;
  std::vector<char> alphaOfMesh_;  ///< some object shows it with alpha
  std::vector<char> hidden_;       ///< by object: rays meet its twin
};

void World::buildTrees(const core::Progress& progress) {
  // One build thread: the tree, and with it the choice between equal distances, is the same on every machine.
  embree_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (!embree_->device) throw core::Error("Embree cannot be started: check that libembree3 is installed");
  rtcSetDeviceMemoryMonitorFunction(embree_->device, countBytes, &embree_->bytes);
  TreeBuilder(*this, *embree_, progress).build();
}

}  // namespace saccade::raytrace
