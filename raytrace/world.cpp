#include "raytrace/world.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "raytrace/embree_scene.h"
#include "raytrace/lights.h"

namespace saccade::raytrace {

World::World(const core::Scene& scene, const core::Plan& plan, const core::Progress& progress)
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
  placeObjects();
  findTwins();
  lights_ = std::make_unique<Lights>(scene, *this);
  for (std::size_t i = 0; i < lights_->emissiveCount(); ++i) {
    records_[lights_->emissiveTriangle(i)].light = static_cast<std::int32_t>(i);
  }
  buildTrees(progress);
}

World::~World() = default;

void World::buildRecords() {
  std::size_t stored = 0;
  for (const core::Mesh& mesh : scene_.meshes) stored += mesh.triangleCount();
  records_.reserve(stored);
  shapes_.reserve(stored);
  constexpr std::uint32_t kNotYet = ~0u;
  std::vector<std::uint32_t> firstOfMesh(scene_.meshes.size(), kNotYet);
  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    std::uint32_t& first = firstOfMesh[scene_.objects[o].mesh];
    if (first == kNotYet) {
      first = static_cast<std::uint32_t>(records_.size());
      addRecords(o);
    }
    firstTriangle_.push_back(first);
  }
}

void World::addRecords(std::uint32_t o) {
  const core::Mesh& mesh = meshOf(o);
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
    s.space = mesh.instanced ? scene_.objects[o].mesh + 1 : 0;
    r.object = o;
    r.offset = largest * kOffsetPerCoordinate;
    records_.push_back(r);
    shapes_.push_back(s);
  }
}

void World::refreshCharts() {
  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    const core::Mesh& mesh = meshOf(o);
    for (std::size_t i = 0; i < mesh.indices.size() && !mesh.lightmapUv.empty(); ++i)
      records_[firstTriangle_[o] + i / 3].lightmapUv[i % 3] = mesh.lightmapUv[mesh.indices[i]];
    if (instanceOf(o)) instances_[instanceOf_[o]].lightmapScaleOffset = scene_.objects[o].lightmapScaleOffset;
  }
}

void World::placeObjects() {
  objectOfId_.assign(scene_.idCount() + 1, 0);
  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    const core::Object& object = scene_.objects[o];
    const core::Mesh& mesh = scene_.meshOf(object);
    flags_.push_back(static_cast<std::uint8_t>(
        (object.closed && !scene_.materials[object.material].thinWalled ? kClosed : 0) |
        (object.id == 0 ? kDiffuse : 0) | (mesh.colors.empty() ? 0 : kColors) |
        (mesh.instanced ? kInstanced : 0) | (mesh.vertexLit ? kVertexLit : 0)));
    if (object.id > 0) objectOfId_[object.id] = o;
    if (!mesh.instanced) continue;
    if (!core::isInstanceable(object.meshToWorld) || materialOf(o).emits()) {
      throw core::Error("object '" + object.name + "' cannot be an instance: it emits or its transform " +
                        "cannot be inverted; completeScene gives it a mesh of its own");
    }
    instanceOf_.resize(scene_.objects.size());
    instanceOf_[o] = static_cast<std::uint32_t>(instances_.size());
    instances_.emplace_back(object.meshToWorld, object.lightmapScaleOffset);
    largestRay_ = std::min(largestRay_, instances_.back().largestRay());
  }
}

void World::findTwins() {
  const auto key = [&](std::uint32_t o) {
    std::array<float, 16> m;
    std::copy_n(&scene_.objects[o].meshToWorld[0][0], m.size(), m.begin());
    return std::pair(scene_.objects[o].mesh, m);
  };
  std::vector<std::uint32_t> order;
  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    if (instanceOf(o)) order.push_back(o);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t first = 0, i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[first])) {
      twins_.push_back({order[first], order[i]});
    } else {
      first = i;
    }
  }
  std::stable_sort(twins_.begin(), twins_.end(), [](const Twin& a, const Twin& b) { return a.met < b.met; });
}

std::span<const Twin> World::twinsOf(std::uint32_t object) const {
  if (twins_.empty()) return {};
  const auto low = std::lower_bound(twins_.begin(), twins_.end(), object,
                                    [](const Twin& t, std::uint32_t o) { return t.met < o; });
  auto high = low;
  while (high != twins_.end() && high->met == object) ++high;
  return {low, high};
}

std::size_t World::bytes() const {
  const auto of = [](const auto& array) { return array.capacity() * sizeof(array[0]); };
  return static_cast<std::size_t>(embree_->bytes) + of(materials_) + of(materialOf_) + of(records_) +
         of(shapes_) + of(firstTriangle_) + of(instances_) + of(instanceOf_) + of(twins_) + of(flags_) +
         of(objectOfId_) + of(mapTexels_) + of(mapBlocks_);
}

std::uint32_t World::objectOfId(std::uint32_t id) const {
  if (id == 0 || id >= objectOfId_.size()) {
    throw core::Error("no object has the ID " + std::to_string(id) +
                      ": frame and scene do not belong together");
  }
  return objectOfId_[id];
}

}  // namespace saccade::raytrace
