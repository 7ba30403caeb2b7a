// The scene as rays see it: Embree's trees, packed per-triangle data, light tables, illumination maps.
//
// One Embree scene holds everything. A mesh of one object is in it as triangles in world space; an instanced
// mesh has a tree of its own in mesh space, which Embree's instances (one level) place. For primary rays each
// non-diffuse object can be met alone (the stencil says which object a pixel shows, design fact 9): through a
// second tree over the same geometry, or through its mesh's tree with the ray taken to the mesh.
// Triangles are stored once per mesh, so a triangle of an instanced mesh belongs to many objects: a hit names
// both, and instanceOf() says how to bring what was read into the world.
// Read-only once built: all const functions may be called from any thread at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "core/maps.h"
#include "core/progress.h"
#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "raytrace/instance.h"
#include "raytrace/material.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

class Lights;

/// What a hit needs when its light comes from the maps: one cache line.
struct alignas(64) TriangleRecord {
  Vec2 lightmapUv[3] = {Vec2(0), Vec2(0), Vec2(0)};
  Vec2 uv0[3] = {Vec2(0), Vec2(0), Vec2(0)};
  std::uint32_t object = 0;  ///< the mesh's only one; of an instanced mesh any: ask Hit::object
  float offset = 0;  ///< in mesh units, by which rays start off this triangle, along the geometric normal
  std::int32_t light = -1;  ///< index of the emissive triangle in Lights
};

/// Three unit normals of 64 bits each: 21 bits a component.
class PackedNormals {
 public:
  void set(int k, const Vec3& n) {
    const auto pack = [](float x) {
      return static_cast<std::uint64_t>(std::lround(x * kOne)) & ((1u << 21) - 1);
    };
    const std::uint64_t bits = pack(n.x) | pack(n.y) << 21 | pack(n.z) << 42;
    std::memcpy(&words_[2 * k], &bits, sizeof bits);
  }
  /// Not exactly unit; 0 where none was set.
  Vec3 operator[](int k) const {
    std::int64_t bits = 0;
    std::memcpy(&bits, &words_[2 * k], sizeof bits);
    return Vec3(static_cast<float>(bits << 43 >> 43), static_cast<float>(bits << 22 >> 43),
                static_cast<float>(bits << 1 >> 43)) *
           (1 / kOne);
  }

 private:
  static constexpr float kOne = (1 << 20) - 1;
  std::uint32_t words_[6] = {};
};

/// What a hit needs beyond that when rays leave it: one more cache line. In the space of its mesh.
struct alignas(64) TriangleShape {
  Vec3 position[3] = {Vec3(0), Vec3(0), Vec3(0)};
  PackedNormals normal;
  std::uint32_t space = 0;  ///< 0 the world; else one number for each instanced mesh
};

/// The illumination map's texels around one point, like TexelFootprint.
struct MapFootprint {
  std::uint32_t at[4] = {};
  float right = 0, down = 0;  ///< texels from the middle of at[0]; negative before that of the atlas's first
  bool dark = true;           ///< no map on this side: irradiance is 0
};

/// An object that lies exactly on another.
struct Twin {
  std::uint32_t met = 0;     ///< the object that rays meet
  std::uint32_t object = 0;  ///< the one they do not
};

class World {
 public:
  /// `scene` is charted (core::applyCharts) when maps are used; it must outlive the world. Builds on the
  /// calling thread. Throws core::Error when Embree fails, soon after `progress.stop` was requested, and for
  /// an instanced mesh whose object emits or whose transform cannot be inverted within the range of floats:
  /// completeScene leaves none. Reported is the share of the common tree, the longest part.
  World(const core::Scene& scene, const core::Plan& plan, const core::Progress& progress = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const core::Scene& scene() const { return scene_; }
  const core::Mesh& meshOf(std::uint32_t object) const { return scene_.meshOf(scene_.objects[object]); }
  int recursionDepth() const { return recursionDepth_; }
  const Lights& lights() const { return *lights_; }

  /// Takes the charts' places from the scene again, after core::placeCharts. Not while another thread traces.
  void refreshCharts();
  /// Irradiance for diffuse hits; the texels are copied into the tracer's layout. Without maps irradiance is
  /// 0. Not while another thread traces.
  void setMaps(const core::IlluminationMaps* maps);
  bool hasMaps() const { return !mapTexels_.empty(); }
  /// Bilinear, finer where the maps have detail (core/map_detail.h); layer 0 front, 1 back (the back of a
  /// single-layer map is 0). W/m^2.
  Vec3 irradiance(const Vec2& lightmapUv, int layer) const {
    return irradiance(mapFootprint(lightmapUv, layer));
  }
  /// The two halves of it.
  MapFootprint mapFootprint(const Vec2& lightmapUv, int layer) const;
  /// Of a point of a triangle (stored, as Hit::triangle) of an object; u and v as in Hit.
  MapFootprint mapFootprint(std::uint32_t object, std::uint32_t triangle, float u, float v, int layer) const;
  /// Where in the atlas the texel is that this point belongs to; on vertex-lit meshes the nearest vertex's.
  Vec2 lightmapUv(std::uint32_t object, std::uint32_t triangle, float u, float v) const;
  Vec3 irradiance(const MapFootprint& f) const;
  void prefetch(const MapFootprint& f) const {
    __builtin_prefetch(mapTexels_.data() + f.at[0]);
    __builtin_prefetch(mapTexels_.data() + f.at[3]);
  }

  /// Of the ray guard: smaller than kLargestRay where instances scale rays up.
  bool traceable(const Ray& ray) const { return raytrace::traceable(ray, largestRay_); }
  /// Nearest hit over all triangles; alpha-masked texels are not there.
  bool intersect(const Ray& ray, Hit& hit, RayCounters& counters) const;
  /// Nearest hit on one object, for primary rays; back faces of single-sided surfaces are not there.
  bool intersectVisible(std::uint32_t object, const Ray& ray, Hit& hit, RayCounters& counters) const;
  /// Nearest hit over all, for primary rays of the path tracer; back faces of single-sided surfaces are not
  /// there.
  bool intersectVisible(const Ray& ray, Hit& hit, RayCounters& counters) const;
  /// The point of a non-diffuse object closest to `point`, as a hit (t = 0). False for an object without
  /// area.
  bool closestPoint(std::uint32_t object, const Vec3& point, Hit& hit) const;
  /// 1 = free, 0 = blocked; between for alphaMode blend in the way. tFar must lie before the light.
  float transmittance(const Ray& ray, RayCounters& counters) const;

  /// What shading a hit will read first.
  void prefetch(const Hit& hit) const {
    __builtin_prefetch(&records_[hit.triangle]);
    if (!diffuse(hit.object)) __builtin_prefetch(&shapes_[hit.triangle]);
  }
  const TriangleRecord& record(std::uint32_t triangle) const { return records_[triangle]; }
  const TriangleShape& shape(std::uint32_t triangle) const { return shapes_[triangle]; }
  const CompiledMaterial& material(std::uint32_t index) const { return materials_[index]; }
  const CompiledMaterial& materialOf(std::uint32_t object) const { return materials_[materialOf_[object]]; }
  std::size_t triangleCount() const { return records_.size(); }  ///< stored
  std::uint32_t firstTriangle(std::uint32_t object) const { return firstTriangle_[object]; }
  std::uint32_t triangleCountOf(std::uint32_t object) const {
    return static_cast<std::uint32_t>(meshOf(object).triangleCount());
  }
  /// Null for an object in world space.
  const Instance* instanceOf(std::uint32_t object) const {
    return flags_[object] & kInstanced ? &instances_[instanceOf_[object]] : nullptr;
  }
  /// Not unit; towards the front, in the world.
  Vec3 geometricNormal(std::uint32_t object, std::uint32_t triangle) const;
  /// Objects with the same instanced mesh in the same place as `object`, which rays meet in its stead.
  std::span<const Twin> twinsOf(std::uint32_t object) const;
  /// Bytes of everything built here, Embree's part as it counts it.
  std::size_t bytes() const;
  /// Transmission, if any, is that of a solid: watertight, and not thin-walled by KHR_materials_volume.
  bool closed(std::uint32_t object) const { return flags_[object] & kClosed; }
  bool solid(std::uint32_t object) const { return closed(object) && materialOf(object).transmission > 0; }
  /// Some solid tints light (core::Plan): paths keep track of the solids they are in.
  bool attenuates() const { return attenuates_; }
  /// Some solid splits light into colours.
  bool disperses() const { return disperses_; }
  bool vertexLit(std::uint32_t object) const { return flags_[object] & kVertexLit; }
  bool hasColors(std::uint32_t object) const { return flags_[object] & kColors; }
  /// ID mask value (1..idCount) to object index; throws core::Error for an unknown id.
  std::uint32_t objectOfId(std::uint32_t id) const;
  bool diffuse(std::uint32_t object) const { return flags_[object] & kDiffuse; }

 private:
  friend class TreeBuilder;
  friend std::uint64_t replayRays(const World& world, const RayLog& log);
  struct Embree;
  enum ObjectFlag : std::uint8_t { kClosed = 1, kDiffuse = 2, kColors = 4, kInstanced = 8, kVertexLit = 16 };
  static constexpr unsigned kMapTileX = 4, kMapTileY = 2;
  Vec2 cornerUv(std::uint32_t object, std::uint32_t triangle, int corner) const;
  std::uint32_t mapTexelAt(const Vec2& uv, int layer) const;
  static std::uint32_t mapColumn(unsigned x);
  std::uint32_t mapRow(unsigned y, int layer) const;
  void copyMapRows(const std::uint16_t* from, int rows, unsigned firstRow, int layer);
  void copyMapBlocks(const core::IlluminationMaps& maps);
  MapFootprint blockFootprint(const MapFootprint& f, std::uint32_t texel) const;
  Vec3 mixMap(const MapFootprint& f) const;
  void buildRecords();
  void addRecords(std::uint32_t firstObject);
  void placeObjects();
  void findTwins();
  void buildTrees(const core::Progress& progress);

  const core::Scene& scene_;
  int recursionDepth_ = 0;
  bool attenuates_ = false, disperses_ = false;
  TextureStore textures_;
  std::vector<CompiledMaterial> materials_;
  std::vector<std::uint32_t> materialOf_;  ///< by object
  HugeVector<TriangleRecord> records_;
  HugeVector<TriangleShape> shapes_;
  std::vector<std::uint32_t> firstTriangle_;  ///< by object
  std::vector<Instance> instances_;
  std::vector<std::uint32_t> instanceOf_;  ///< by object, into instances_; empty without instances
  std::vector<Twin> twins_;                ///< by the object that rays meet
  float largestRay_ = kLargestRay;
  std::vector<std::uint8_t> flags_;  ///< by object
  std::vector<std::uint32_t> objectOfId_;
  /// RGB as halves and 16 bits that say whether the texel has a block; 4 x 2 to a cache line. Each layer: the
  /// atlas, then the rows of its detail.
  HugeVector<std::uint64_t> mapTexels_;
  HugeVector<std::uint32_t> mapBlocks_;  ///< by place in layer 0 of mapTexels_; empty without detail
  unsigned mapTilesAcross_ = 0, mapTilesDown_ = 0;  ///< of one layer
  unsigned mapDetailRow_ = 0;                       ///< the first row of a layer's detail
  int mapWidth_ = 0, mapHeight_ = 0, mapLayers_ = 0;
  std::unique_ptr<Lights> lights_;
  std::unique_ptr<Embree> embree_;
};

/// Where a ray leaving `position` towards `direction` starts: shifted along the geometric normal by the
/// triangle's offset, a bound on the rounding of the hit point. The bound is relative to the triangle's
/// coordinates, so scaling a scene by a power of two scales the offset exactly.
inline Vec3 offsetOrigin(const Vec3& position, const Vec3& ngUnit, const Vec3& direction, float offset) {
  return position + ngUnit * (glm::dot(ngUnit, direction) >= 0 ? offset : -offset);
}

}  // namespace saccade::raytrace
