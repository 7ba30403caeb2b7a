#include "core/scene/instances.h"

#include <string>
#include <utility>
#include <vector>

#include "core/scene/placement.h"

namespace saccade::core {
namespace {

/// What the objects of an instanced mesh ask of it.
struct Use {
  std::size_t objects = 0;  ///< all
  std::size_t sharing = 0;  ///< those that could share it
};

bool canShare(const Scene& scene, const Object& o) {
  return !scene.materials[static_cast<std::size_t>(o.material)].emits() && isInstanceable(o.meshToWorld);
}

std::vector<Use> countUses(const Scene& scene) {
  std::vector<Use> uses(scene.meshes.size());
  for (const Object& o : scene.objects) {
    ++uses[o.mesh].objects;
    uses[o.mesh].sharing += scene.meshOf(o).instanced && canShare(scene, o);
  }
  return uses;
}

std::uint64_t bytesOf(const Mesh& m) {
  const auto of = [](const auto& array) { return array.size() * sizeof(array[0]); };
  return of(m.positions) + of(m.normals) + of(m.tangents) + of(m.uv0) + of(m.uv1) + of(m.colors) +
         of(m.indices);
}

bool pays(const Mesh& mesh, const Use& use) {
  return use.sharing >= 2 && mesh.triangleCount() >= kFewestInstancedTriangles;
}

void checkCounts(const Scene& scene, const std::vector<Use>& uses) {
  std::size_t stored = 0, shown = 0;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const std::size_t triangles = scene.meshes[m].triangleCount();
    stored += triangles * (uses[m].objects - uses[m].sharing + (uses[m].sharing > 0 ? 1 : 0));
    shown += triangles * uses[m].objects;
  }
  if (stored > kMaxStoredTriangles)
    throw Error(scene.path + ": more than " + std::to_string(kMaxStoredTriangles) + " triangles");
  if (shown > kMaxShownTriangles)
    throw Error(scene.path + ": more than " + std::to_string(kMaxShownTriangles) +
                " triangles with all instances");
}

}  // namespace

void bakeIntoWorld(Mesh& mesh, const Mat4& meshToWorld) {
  const Placement place(meshToWorld);
  for (Vec3& p : mesh.positions) p = Vec3(meshToWorld * Vec4(p, 1));
  for (Vec3& n : mesh.normals) n = glm::normalize(place.normalToWorld * n);
  for (Vec4& t : mesh.tangents) t = place.tangent(t);
  mesh.instanced = false;
  if (!place.mirrored) return;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

double surfaceArea(const Scene& scene, const Object& object) {
  const Mesh& mesh = scene.meshOf(object);
  const Placement place(object.meshToWorld);
  double twice = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3 a = mesh.positions[mesh.indices[i]];
    Vec3 across =
        glm::cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
    if (mesh.instanced) across = place.normalToWorld * across;
    twice += static_cast<double>(glm::length(across));
  }
  return 0.5 * twice;
}

void chooseInstances(Scene& scene, std::size_t sharingPays, LoadBudget* budget) {
  std::vector<Use> uses = countUses(scene);
  std::size_t saved = 0;
  for (std::size_t m = 0; m < uses.size(); ++m) {
    if (!pays(scene.meshes[m], uses[m])) uses[m].sharing = 0;
    if (uses[m].sharing > 0) saved += (uses[m].sharing - 1) * scene.meshes[m].triangleCount();
  }
  if (saved < sharingPays) {
    for (Use& use : uses) use.sharing = 0;
  }
  checkCounts(scene, uses);
  for (Object& o : scene.objects) {
    Use& use = uses[o.mesh];
    if (!scene.meshOf(o).instanced || (use.sharing > 0 && canShare(scene, o))) continue;
    const bool last = --use.objects == 0;  // takes the mesh along
    if (budget && !last) budget->charge(bytesOf(scene.meshOf(o)), "the mesh of '" + o.name + "'");
    Mesh own = last ? std::exchange(scene.meshOf(o), Mesh{}) : scene.meshOf(o);
    bakeIntoWorld(own, o.meshToWorld);
    o.meshToWorld = Mat4(1);
    o.mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(own));
  }
}

}  // namespace saccade::core
