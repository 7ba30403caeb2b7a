#include "core/scene/mesh_repair.h"

#include <bit>
#include <cmath>
#include <unordered_map>

#include "core/scene/tangents.h"

namespace saccade::core {
namespace {

template <class V>
bool finite(const V& v) {
  for (int i = 0; i < V::length(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

template <class T>
void dropWrongLength(std::vector<T>& array, std::size_t vertices, RepairCounts& counts) {
  if (array.empty() || array.size() == vertices) return;
  array.clear();
  ++counts.attributes;
}

Vec3 triangleCross(const Mesh& m, std::size_t first) {
  const Vec3& a = m.positions[m.indices[first]];
  return glm::cross(m.positions[m.indices[first + 1]] - a, m.positions[m.indices[first + 2]] - a);
}

bool usable(const Mesh& m, std::size_t first) {
  for (std::size_t k = first; k < first + 3; ++k)
    if (m.indices[k] >= m.positions.size() || !finite(m.positions[m.indices[k]])) return false;
  // Products of small edges underflow in float long before the triangle has no area.
  const glm::dvec3 a(m.positions[m.indices[first]]);
  const glm::dvec3 across = glm::cross(glm::dvec3(m.positions[m.indices[first + 1]]) - a,
                                       glm::dvec3(m.positions[m.indices[first + 2]]) - a);
  const double area = glm::length(across);
  return area > 0 && std::isfinite(area);
}

void dropBadTriangles(Mesh& m, RepairCounts& counts) {
  std::size_t kept = 0;
  const std::size_t whole = m.indices.size() / 3 * 3;
  for (std::size_t first = 0; first < whole; first += 3) {
    if (!usable(m, first)) continue;
    for (std::size_t k = 0; k < 3; ++k) m.indices[kept + k] = m.indices[first + k];
    kept += 3;
  }
  counts.triangles += (m.indices.size() - kept + 2) / 3;
  m.indices.resize(kept);
}

template <class T>
std::vector<T> gather(const std::vector<T>& from, const std::vector<std::uint32_t>& sources) {
  if (from.empty()) return {};
  std::vector<T> out(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) out[i] = from[sources[i]];
  return out;
}

/// The unit normal of a triangle, in double precision so that small triangles have one too.
Vec3 faceNormal(const Mesh& m, std::size_t first) {
  const glm::dvec3 a(m.positions[m.indices[first]]);
  return Vec3(glm::normalize(glm::cross(glm::dvec3(m.positions[m.indices[first + 1]]) - a,
                                        glm::dvec3(m.positions[m.indices[first + 2]]) - a)));
}

void flatNormals(Mesh& m) {
  const std::vector<std::uint32_t> corners = m.indices;
  Mesh split = gatherVertices(m, corners);
  split.indices.resize(corners.size());
  split.normals.resize(corners.size());
  for (std::size_t first = 0; first + 2 < corners.size(); first += 3) {
    const Vec3 n = faceNormal(m, first);
    for (std::size_t k = first; k < first + 3; ++k) {
      split.indices[k] = static_cast<std::uint32_t>(k);
      split.normals[k] = n;
    }
  }
  m = std::move(split);
}

/// Normals that are not finite or far from unit length become the area-weighted mean of their triangles'.
void repairNormals(Mesh& m, RepairCounts& counts) {
  constexpr float kShortest = 1e-6f;
  std::vector<char> bad(m.normals.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < m.normals.size(); ++i) {
    Vec3& n = m.normals[i];
    const float length = glm::length(n);
    bad[i] = !finite(n) || !(length > kShortest) || !std::isfinite(length);
    n = bad[i] ? Vec3(0) : n / length;
    any |= bad[i] != 0;
  }
  if (!any) return;
  for (std::size_t first = 0; first + 2 < m.indices.size(); first += 3)
    for (std::size_t k = first; k < first + 3; ++k)
      if (bad[m.indices[k]]) m.normals[m.indices[k]] += triangleCross(m, first);
  for (std::size_t i = 0; i < m.normals.size(); ++i) {
    if (!bad[i]) continue;
    const float length = glm::length(m.normals[i]);
    m.normals[i] = length > 0 ? m.normals[i] / length : Vec3(0, 1, 0);
    ++counts.normals;
  }
}

void repairTangents(Mesh& m) {
  for (std::size_t i = 0; i < m.tangents.size(); ++i) {
    Vec3 t(m.tangents[i]);
    const float length = glm::length(t);
    t = finite(m.tangents[i]) && length > 0 ? t / length : anyPerpendicular(m.normals[i]);
    m.tangents[i] = Vec4(t, m.tangents[i].w < 0 ? -1.0f : 1.0f);
  }
}

template <class V>
void zeroNotFinite(std::vector<V>& array) {
  for (V& v : array)
    if (!finite(v)) v = V(0);
}

}  // namespace

void repairMesh(Mesh& mesh, const Material& material, RepairCounts& counts) {
  const std::size_t vertices = mesh.positions.size();
  dropWrongLength(mesh.normals, vertices, counts);
  dropWrongLength(mesh.tangents, vertices, counts);
  dropWrongLength(mesh.uv0, vertices, counts);
  dropWrongLength(mesh.uv1, vertices, counts);
  dropWrongLength(mesh.colors, vertices, counts);
  dropWrongLength(mesh.lightmapUv, vertices, counts);
  dropBadTriangles(mesh, counts);
  zeroNotFinite(mesh.uv0);
  zeroNotFinite(mesh.uv1);
  zeroNotFinite(mesh.colors);
  if (mesh.normals.empty()) {
    flatNormals(mesh);
  } else {
    repairNormals(mesh, counts);
  }
  if (!material.needsTangents()) {
    mesh.tangents.clear();
  } else if (mesh.tangents.empty()) {
    makeTangents(mesh, material);
  } else {
    repairTangents(mesh);
  }
}

std::vector<std::uint32_t> weldedVertices(const std::vector<Vec3>& positions) {
  struct Hash {
    std::size_t operator()(const Vec3& p) const {
      std::uint64_t h = 0;
      for (int c = 0; c < 3; ++c) {
        const std::uint64_t bits = p[c] == 0 ? 0u : std::bit_cast<std::uint32_t>(p[c]);
        h = (h ^ bits) * 0x9E3779B97F4A7C15ull;
        h ^= h >> 29;
      }
      return h;
    }
  };
  std::unordered_map<Vec3, std::uint32_t, Hash> first;
  first.reserve(positions.size());
  std::vector<std::uint32_t> out(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    out[i] = first.try_emplace(positions[i], static_cast<std::uint32_t>(i)).first->second;
  return out;
}

Mesh gatherVertices(const Mesh& m, const std::vector<std::uint32_t>& sources) {
  Mesh out;
  out.instanced = m.instanced;
  out.positions = gather(m.positions, sources);
  out.normals = gather(m.normals, sources);
  out.tangents = gather(m.tangents, sources);
  out.uv0 = gather(m.uv0, sources);
  out.uv1 = gather(m.uv1, sources);
  out.colors = gather(m.colors, sources);
  out.lightmapUv = gather(m.lightmapUv, sources);
  return out;
}

Mesh subMesh(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  constexpr std::uint32_t kUnseen = 0xFFFFFFFFu;
  std::vector<std::uint32_t> renamed(mesh.positions.size(), kUnseen), sources, indices;
  indices.reserve(triangles.size() * 3);
  for (const std::uint32_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.indices[std::size_t{3} * t + k];
      if (renamed[v] == kUnseen) {
        renamed[v] = static_cast<std::uint32_t>(sources.size());
        sources.push_back(v);
      }
      indices.push_back(renamed[v]);
    }
  }
  Mesh out = gatherVertices(mesh, sources);
  out.indices = std::move(indices);
  return out;
}

}  // namespace saccade::core
