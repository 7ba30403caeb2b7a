#include "render/base/solid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

namespace saccade::render {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// For each vertex the first one in the same place.
std::vector<std::uint32_t> weld(const std::vector<core::Vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const core::Vec3 &p = positions[a], &q = positions[b];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    return p.z != q.z ? p.z < q.z : a < b;
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<std::uint32_t> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

std::vector<Triangle> weldedTriangles(const core::Mesh& mesh) {
  const std::vector<std::uint32_t> first = weld(mesh.positions);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Triangle t{first[mesh.indices[i]], first[mesh.indices[i + 1]], first[mesh.indices[i + 2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

bool edgesBalance(const std::vector<Triangle>& triangles) {
  std::vector<std::uint64_t> forward, backward;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
      forward.push_back(a << 32 | b);
      backward.push_back(b << 32 | a);
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return forward == backward;
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

bool partsEnclosePositiveVolume(const core::Mesh& mesh, const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const Triangle& t : triangles) {
    parent[rootOf(parent, t[1])] = rootOf(parent, t[0]);
    parent[rootOf(parent, t[2])] = rootOf(parent, t[0]);
  }
  std::vector<double> volume(mesh.positions.size(), 0);
  for (const Triangle& t : triangles) {
    const std::uint32_t root = rootOf(parent, t[0]);
    // Relative to a vertex of the part: far from the origin the products would cancel.
    const glm::dvec3 origin(mesh.positions[root]);
    const glm::dvec3 a = glm::dvec3(mesh.positions[t[0]]) - origin;
    const glm::dvec3 b = glm::dvec3(mesh.positions[t[1]]) - origin;
    const glm::dvec3 c = glm::dvec3(mesh.positions[t[2]]) - origin;
    volume[root] += glm::dot(a, glm::cross(b, c));
  }
  return std::all_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return volume[rootOf(parent, t[0])] > 0; });
}

}  // namespace

bool isOutwardSolid(const core::Mesh& mesh) {
  const std::vector<Triangle> triangles = weldedTriangles(mesh);
  return !triangles.empty() && edgesBalance(triangles) && partsEnclosePositiveVolume(mesh, triangles);
}

}  // namespace saccade::render
