#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/scene/clusters.h"
#include "core/scene/defaults.h"
#include "core/scene/hierarchy.h"
#include "core/scene/instances.h"
#include "core/scene/load.h"
#include "core/scene/mesh_repair.h"
#include "core/scene/placement.h"
#include "core/scene/plan.h"

namespace saccade::core {
namespace {

const Material& materialOf(const Scene& scene, const Object& object) {
  return scene.materials[static_cast<std::size_t>(object.material)];
}

void repairAll(Scene& scene) {
  // A shared mesh serves the first of its materials that needs tangents; the loaders let only those share
  // that agree on them.
  std::vector<const Material*> materialOfMesh(scene.meshes.size(), nullptr);
  for (const Object& o : scene.objects) {
    const Material& m = materialOf(scene, o);
    const Material*& chosen = materialOfMesh[o.mesh];
    if (!chosen || (m.needsTangents() && !chosen->needsTangents())) chosen = &m;
  }
  RepairCounts counts;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    if (materialOfMesh[i]) repairMesh(scene.meshes[i], *materialOfMesh[i], counts);
  std::erase_if(scene.objects, [&](const Object& o) { return scene.meshOf(o).indices.empty(); });
  const auto warn = [&](std::uint64_t n, const char* what) {
    if (n > 0) scene.warnings.push_back(std::to_string(n) + what);
  };
  warn(counts.triangles,
       " triangles were dropped (no area, a vertex that is not finite, or an index out of range)");
  warn(counts.attributes, " vertex arrays of the wrong length were dropped");
  warn(counts.normals, " normals were of no use and were computed anew");
}

bool nodeHasSeveral(const std::vector<Object>& objects, std::size_t at) {
  const auto sameNode = [&](std::size_t i) { return objects[i].node == objects[at].node; };
  return (at > 0 && sameNode(at - 1)) || (at + 1 < objects.size() && sameNode(at + 1));
}

/// Splits meshes into clusters, a shared mesh once for all of its objects, or twice when some of them
/// transmit and others do not.
class MeshSplitter {
 public:
  explicit MeshSplitter(std::vector<Mesh>& meshes) : from_(meshes) {}

  struct Split {
    std::vector<Cluster> clusters;
    std::vector<std::uint32_t> meshes;  ///< by cluster, into take()
  };
  const Split& split(std::uint32_t mesh, bool separateClosed) {
    const auto [at, isNew] = splits_.try_emplace({mesh, separateClosed});
    Split& out = at->second;
    if (!isNew) return out;
    out.clusters = clusterMesh(from_[mesh], separateClosed);
    if (out.clusters.size() == 1) {
      const auto [whole, first] = whole_.try_emplace(mesh, static_cast<std::uint32_t>(to_.size()));
      if (first) to_.emplace_back();
      out.meshes.push_back(whole->second);
      return out;
    }
    for (const Cluster& c : out.clusters) {
      out.meshes.push_back(static_cast<std::uint32_t>(to_.size()));
      to_.push_back(subMesh(from_[mesh], c.triangles));
    }
    return out;
  }
  /// The new meshes; the old ones are used up.
  std::vector<Mesh> take() {
    for (const auto& [old, now] : whole_) to_[now] = std::move(from_[old]);
    return std::move(to_);
  }

 private:
  std::vector<Mesh>& from_;
  std::vector<Mesh> to_;
  std::map<std::pair<std::uint32_t, bool>, Split> splits_;
  std::map<std::uint32_t, std::uint32_t> whole_;  ///< meshes of one cluster: old to new
};

/// Objects in order of (node, primitive), each replaced by its clusters.
void splitIntoClusters(Scene& scene) {
  std::stable_sort(scene.objects.begin(), scene.objects.end(), [](const Object& a, const Object& b) {
    return std::tie(a.node, a.primitive) < std::tie(b.node, b.primitive);
  });
  MeshSplitter splitter(scene.meshes);
  std::vector<Object> out;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    Object& whole = scene.objects[i];
    if (nodeHasSeveral(scene.objects, i)) whole.name += "/" + std::to_string(whole.primitive);
    const auto& [clusters, meshes] = splitter.split(whole.mesh, materialOf(scene, whole).transmission > 0);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      Object part;
      part.name = clusters.size() > 1 ? whole.name + "#" + std::to_string(c) : whole.name;
      part.node = whole.node;
      part.primitive = whole.primitive;
      part.cluster = static_cast<int>(c);
      part.material = whole.material;
      part.closed = clusters[c].closed;
      part.mesh = meshes[c];
      part.meshToWorld = whole.meshToWorld;
      out.push_back(std::move(part));
    }
  }
  scene.objects = std::move(out);
  scene.meshes = splitter.take();
}

void findBounds(Scene& scene) {
  scene.bounds = Bounds{};
  for (Object& o : scene.objects) {
    o.bounds = Bounds{};
    const Mesh& mesh = scene.meshOf(o);
    if (mesh.instanced) {
      const Placement place(o.meshToWorld);
      for (const std::uint32_t i : mesh.indices) o.bounds.add(place.point(mesh.positions[i]));
    } else {
      for (const std::uint32_t i : mesh.indices) o.bounds.add(mesh.positions[i]);
    }
    scene.bounds.add(o.bounds);
  }
}

void assignIds(Scene& scene, float threshold) {
  std::vector<float> albedo;
  for (const Material& m : scene.materials) albedo.push_back(nonDiffuseAlbedo(scene, m));
  std::uint32_t next = 1;
  for (Object& o : scene.objects) {
    o.nonDiffuseAlbedo = albedo[static_cast<std::size_t>(o.material)];
    o.id = o.nonDiffuseAlbedo > threshold ? next++ : 0;
  }
}

/// No light was asked for, and none is certain to do: whether emitters do is for onlyDimEmitters to say.
bool mayBeDark(const Scene& scene, const LoadOptions& options) {
  return options.lights.empty() && scene.lights.empty() && !scene.environment &&
         std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& o) { return !materialOf(scene, o).unlit; });
}

void addDefaults(Scene& scene, const Surroundings& around, bool camera, bool light) {
  if (camera) {
    scene.cameras.push_back(defaultCamera(scene, around));
    scene.defaultCamera = true;
    scene.warnings.emplace_back("the scene has no camera: the default camera frames it");
  }
  if (light) {
    addDefaultLight(scene, around);
    scene.defaultLight = true;
    scene.warnings.emplace_back(
        "the scene has no light that one would see by: a default light panel was added; --light or "
        "--environment adds another instead");
  }
}

void warnOfUnit(Scene& scene) {
  const Vec3 size = scene.bounds.extent();
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the room is %.0f x %.0f m wide and %.0f m high: if the file's unit is not the metre, name it, "
      "as in --unit-scale 0.01 for centimetres",
      size.x, size.z, size.y);
  scene.warnings.emplace_back(text);
}

/// Every object names a material that is there; scenes made in memory may leave their nodes to be made here.
void checkObjects(Scene& scene) {
  for (const Object& o : scene.objects) {
    if (o.node >= static_cast<int>(scene.nodes.size()))
      scene.nodes.resize(static_cast<std::size_t>(o.node) + 1);
    if (o.material < 0 || static_cast<std::size_t>(o.material) >= scene.materials.size())
      throw Error(scene.path + ": object '" + o.name + "' names a material that is not there");
  }
}

/// With the warnings, which say where the triangles went.
[[noreturn]] void refuseEmpty(const Scene& scene) {
  std::string text = scene.path + ": holds no triangle to show";
  for (std::size_t i = 0; i < scene.warnings.size(); ++i) text += (i == 0 ? " (" : "; ") + scene.warnings[i];
  throw Error(scene.warnings.empty() ? text : text + ")");
}

}  // namespace

void completeScene(Scene& scene, const LoadOptions& options, LoadBudget* budget) {
  const auto lookAtClock = [&] {
    if (budget) budget->checkTime();
  };
  checkObjects(scene);
  scene.timeSeconds = options.timeSeconds;
  for (const std::string& light : options.lights) addLight(scene, light);
  chooseInstances(scene, options.sharingPays, budget);
  repairAll(scene);
  lookAtClock();
  if (scene.objects.empty()) refuseEmpty(scene);
  findBounds(scene);
  const bool noCamera = scene.cameras.empty(), dark = mayBeDark(scene, options);
  if (noCamera || dark) {
    // Looked at once, before a default light changes the bounds.
    const Surroundings around = look(scene);
    if (isNoMetreRoom(scene, around)) warnOfUnit(scene);
    addDefaults(scene, around, noCamera, dark && onlyDimEmitters(scene, around));
  }
  lookAtClock();
  splitIntoClusters(scene);
  lookAtClock();
  findBounds(scene);
  assignIds(scene, options.nonDiffuseThreshold);
  scene.hierarchy = buildHierarchy(scene.objects);
}

}  // namespace saccade::core
