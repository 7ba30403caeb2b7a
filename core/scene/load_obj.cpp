#include <tiny_obj_loader.h>

#include <algorithm>
#include <bit>
#include <map>
#include <sstream>
#include <unordered_map>

#include "core/scene/confined_file.h"
#include "core/scene/crease_normals.h"
#include "core/scene/loaders.h"
#include "core/scene/obj_gate.h"
#include "core/scene/obj_materials.h"

namespace saccade::core {
namespace {

constexpr float kCreaseDegrees = 30;

/// Reads only MTL files in the scene's folder. What goes wrong is kept and thrown once tinyobj has returned.
class ConfinedMtlReader : public tinyobj::MaterialReader {
 public:
  ConfinedMtlReader(const std::filesystem::path& folder, LoadBudget& budget)
      : folder_(folder), budget_(budget) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* byName, std::string* warning, std::string* error) override {
    if (!refused_.empty()) return false;
    try {
      const auto file = confinedFileIfThere(folder_, name, "mtllib");
      if (!file) {
        *warning += std::string("material library ").append(name) + " does not exist beside the scene\n";
        return false;
      }
      std::istringstream in(readGatedMtl(*file, budget_));
      tinyobj::LoadMtl(byName, materials, &in, warning, error);
    } catch (const Error& e) {
      refused_ = e.what();
      return false;
    }
    return true;
  }

  const std::string& refused() const { return refused_; }

 private:
  const std::filesystem::path& folder_;
  LoadBudget& budget_;
  std::string refused_;
};

struct Parsed {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
};

/// The parser's own warnings; it repeats some for every material, so only the first few are kept.
void addLines(const std::string& text, Warnings& warnings) {
  constexpr int kKept = 3;
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && ++count <= kKept) warnings.push_back(line);
  if (count > kKept)
    warnings.push_back("and " + std::to_string(count - kKept) + " more such lines from the OBJ parser");
}

Parsed parse(const std::filesystem::path& file, Warnings& warnings, LoadBudget& budget) {
  const std::string who = file.filename().string();
  const std::filesystem::path folder = file.parent_path();
  Repairs repairs;
  std::istringstream in(readGatedObj(file, repairs, budget));
  repairs.report(warnings);
  Parsed out;
  ConfinedMtlReader reader(folder, budget);
  std::string warning, error;
  const bool good = tinyobj::LoadObj(&out.attributes, &out.shapes, &out.materials, &warning, &error, &in,
                                     &reader, true, false);
  budget.checkTime();
  if (!reader.refused().empty()) throw Error(who + ": " + reader.refused());
  std::replace(error.begin(), error.end(), '\n', ' ');
  if (!good) throw Error(who + ": " + (error.empty() ? "not an OBJ file" : error));
  addLines(warning, warnings);
  return out;
}

/// The corners of one shape's triangles of one material.
using Corners = std::vector<tinyobj::index_t>;

/// Corners with a vertex that is out of range, three at a time, are dropped here and counted: what follows
/// reads positions by them. Texture and normal indices out of range count as absent.
void dropBadCorners(Corners& corners, const tinyobj::attrib_t& a, std::uint64_t& dropped) {
  const auto within = [](int index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) < count;
  };
  const std::size_t vertices = a.vertices.size() / 3, normals = a.normals.size() / 3,
                    uvs = a.texcoords.size() / 2;
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    bool good = true;
    for (std::size_t k = i; k < i + 3; ++k) {
      good = good && within(corners[k].vertex_index, vertices);
      if (!within(corners[k].normal_index, normals)) corners[k].normal_index = -1;
      if (!within(corners[k].texcoord_index, uvs)) corners[k].texcoord_index = -1;
    }
    if (good) {
      std::copy_n(corners.begin() + static_cast<std::ptrdiff_t>(i), 3,
                  corners.begin() + static_cast<std::ptrdiff_t>(kept));
      kept += 3;
    } else {
      ++dropped;
    }
  }
  corners.resize(kept);
}

Vec3 vec3At(const std::vector<tinyobj::real_t>& from, int index) {
  const std::size_t at = 3 * static_cast<std::size_t>(index);
  return Vec3(from[at], from[at + 1], from[at + 2]);
}

std::vector<Vec3> cornerNormals(const Corners& corners, const tinyobj::attrib_t& a) {
  std::vector<Vec3> out(corners.size());
  const bool given = std::all_of(corners.begin(), corners.end(),
                                 [](const tinyobj::index_t& c) { return c.normal_index >= 0; });
  if (given) {
    for (std::size_t i = 0; i < corners.size(); ++i) out[i] = vec3At(a.normals, corners[i].normal_index);
    return out;
  }
  std::vector<Vec3> positions(corners.size());
  std::vector<std::uint32_t> indices(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    positions[i] = vec3At(a.vertices, corners[i].vertex_index);
    indices[i] = static_cast<std::uint32_t>(i);
  }
  return creaseNormals(positions, indices, kCreaseDegrees);
}

struct VertexKey {
  int vertex, uv;
  std::uint32_t n[3];
  bool operator==(const VertexKey&) const = default;
};
struct VertexHash {
  std::size_t operator()(const VertexKey& k) const {
    std::uint64_t h = 0;
    for (const std::uint32_t w :
         {static_cast<std::uint32_t>(k.vertex), static_cast<std::uint32_t>(k.uv), k.n[0], k.n[1], k.n[2]}) {
      h = (h ^ w) * 0x9E3779B97F4A7C15ull;
      h ^= h >> 32;
    }
    return h;
  }
};

Mesh meshOf(const Corners& corners, const tinyobj::attrib_t& a, float unitScale) {
  const std::vector<Vec3> normals = cornerNormals(corners, a);
  const bool hasUv = std::any_of(corners.begin(), corners.end(),
                                 [](const tinyobj::index_t& c) { return c.texcoord_index >= 0; });
  Mesh mesh;
  std::unordered_map<VertexKey, std::uint32_t, VertexHash> seen;
  seen.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& n = normals[i];
    const VertexKey key{corners[i].vertex_index,
                        corners[i].texcoord_index,
                        {std::bit_cast<std::uint32_t>(n.x), std::bit_cast<std::uint32_t>(n.y),
                         std::bit_cast<std::uint32_t>(n.z)}};
    const auto [at, isNew] = seen.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (isNew) {
      mesh.positions.push_back(vec3At(a.vertices, key.vertex) * unitScale);
      mesh.normals.push_back(n);
      if (hasUv) {
        // OBJ's v runs up, ours down.
        const std::size_t t = 2 * static_cast<std::size_t>(std::max(key.uv, 0));
        mesh.uv0.push_back(key.uv < 0 ? Vec2(0) : Vec2(a.texcoords[t], 1 - a.texcoords[t + 1]));
      }
    }
    mesh.indices.push_back(at->second);
  }
  return mesh;
}

/// Triangles of a shape by material (-1: none), in ascending order of material.
std::map<int, Corners> byMaterial(const tinyobj::mesh_t& mesh, std::size_t materials) {
  std::map<int, Corners> out;
  std::size_t at = 0;
  for (std::size_t face = 0; face < mesh.num_face_vertices.size(); ++face) {
    const std::size_t n = mesh.num_face_vertices[face];
    int material = face < mesh.material_ids.size() ? mesh.material_ids[face] : -1;
    if (material < 0 || static_cast<std::size_t>(material) >= materials) material = -1;
    if (n == 3 && at + 3 <= mesh.indices.size()) {
      const auto from = mesh.indices.begin() + static_cast<std::ptrdiff_t>(at);
      Corners& corners = out[material];
      corners.insert(corners.end(), from, from + 3);
    }
    at += n;
  }
  return out;
}

int defaultMaterial(Scene& scene) {
  Material m;
  m.name = "OBJ default";
  m.baseColor = Vec3(0.7f);
  m.metallic = 0;
  m.specular = 0;
  m.doubleSided = true;
  scene.materials.push_back(m);
  return static_cast<int>(scene.materials.size()) - 1;
}

}  // namespace

Scene loadObj(const std::filesystem::path& file, const LoadOptions& options, LoadBudget& budget) {
  Scene scene;
  scene.path = file.string();
  const Parsed parsed = parse(file, scene.warnings, budget);
  convertObjMaterials(parsed.materials, file.parent_path(), scene, budget);
  const std::size_t given = scene.materials.size();
  int standard = -1;
  std::uint64_t dropped = 0;
  for (const tinyobj::shape_t& shape : parsed.shapes) {
    Node node;
    node.name =
        shape.name.empty() ? std::string("shape ").append(std::to_string(scene.nodes.size())) : shape.name;
    scene.nodes.push_back(node);
    int primitive = 0;
    std::map<int, Corners> triangles = byMaterial(shape.mesh, given);
    for (auto& [material, corners] : triangles) {
      dropBadCorners(corners, parsed.attributes, dropped);
      if (material < 0 && standard < 0) standard = defaultMaterial(scene);
      Object object;
      object.name = node.name;
      object.node = static_cast<int>(scene.nodes.size()) - 1;
      object.primitive = primitive++;
      object.material = material < 0 ? standard : material;
      scene.add(std::move(object), meshOf(corners, parsed.attributes, options.unitScale));
    }
  }
  if (dropped > 0)
    scene.warnings.push_back(std::to_string(dropped) + " triangles with an index out of range were dropped");
  return scene;
}

}  // namespace saccade::core
