#include "core/scene/clusters.h"

#include <algorithm>
#include <numeric>

#include "core/scene/mesh_repair.h"
#include "core/union_find.h"

namespace saccade::core {
namespace {

/// A gap separates two groups when it is wider than this part of their common box's longest side.
constexpr float kGapOfExtent = 0.1f;

struct Part {
  Bounds bounds;
  std::vector<std::uint32_t> triangles;
  bool closed = true;
};

struct Edge {
  std::uint32_t low, high;
  std::uint32_t part;
  std::int8_t direction;
};

/// Marks as open the parts with an edge that is not used exactly once in either direction.
void findOpenParts(std::vector<Edge>& edges, std::vector<Part>& parts) {
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  for (std::size_t from = 0; from < edges.size();) {
    std::size_t to = from;
    int balance = 0;
    for (; to < edges.size() && edges[to].low == edges[from].low && edges[to].high == edges[from].high; ++to)
      balance += edges[to].direction;
    if (to - from != 2 || balance != 0) parts[edges[from].part].closed = false;
    from = to;
  }
}

std::vector<Part> connectedParts(const Mesh& mesh) {
  const std::vector<std::uint32_t> weld = weldedVertices(mesh.positions);
  UnionFind vertices(mesh.positions.size());
  const std::size_t count = mesh.triangleCount();
  const auto corner = [&](std::size_t t, std::size_t k) { return weld[mesh.indices[3 * t + k]]; };
  for (std::size_t t = 0; t < count; ++t) {
    vertices.unite(corner(t, 0), corner(t, 1));
    vertices.unite(corner(t, 0), corner(t, 2));
  }
  std::vector<Part> parts;
  std::vector<std::uint32_t> partOfRoot(mesh.positions.size(), 0xFFFFFFFFu);
  std::vector<Edge> edges;
  edges.reserve(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    std::uint32_t& part = partOfRoot[vertices.find(corner(t, 0))];
    if (part == 0xFFFFFFFFu) {
      part = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[part].triangles.push_back(static_cast<std::uint32_t>(t));
    for (std::size_t k = 0; k < 3; ++k) {
      parts[part].bounds.add(mesh.positions[mesh.indices[3 * t + k]]);
      const std::uint32_t a = corner(t, k), b = corner(t, (k + 1) % 3);
      edges.push_back({std::min(a, b), std::max(a, b), part, static_cast<std::int8_t>(a < b ? 1 : -1)});
    }
  }
  findOpenParts(edges, parts);
  return parts;
}

using PartList = std::vector<std::uint32_t>;

struct Gap {
  float width = 0;
  std::size_t split = 0;  ///< parts before this one lie below the gap
};

/// The widest gap between boxes along an axis; leaves `list` sorted along it.
Gap widestGap(PartList& list, const std::vector<Part>& parts, int axis) {
  std::sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float la = parts[a].bounds.lo[axis], lb = parts[b].bounds.lo[axis];
    return la != lb ? la < lb : a < b;
  });
  Gap widest;
  float reached = parts[list[0]].bounds.hi[axis];
  for (std::size_t i = 1; i < list.size(); ++i) {
    const float width = parts[list[i]].bounds.lo[axis] - reached;
    if (width > widest.width) widest = {width, i};
    reached = std::max(reached, parts[list[i]].bounds.hi[axis]);
  }
  return widest;
}

/// Splits at the widest gap as long as there is one worth it.
void splitByGaps(PartList all, const std::vector<Part>& parts, std::vector<PartList>& out) {
  std::vector<PartList> open;
  if (!all.empty()) open.push_back(std::move(all));
  while (!open.empty()) {
    PartList list = std::move(open.back());
    open.pop_back();
    Bounds box;
    for (const std::uint32_t p : list) box.add(parts[p].bounds);
    const Vec3 extent = box.extent();
    const float needed = kGapOfExtent * std::max({extent.x, extent.y, extent.z});
    Gap best;
    int bestAxis = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Gap gap = widestGap(list, parts, axis);
      if (gap.width > best.width) best = gap, bestAxis = axis;
    }
    if (!(best.width > needed)) {
      out.push_back(std::move(list));
      continue;
    }
    widestGap(list, parts, bestAxis);
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(best.split);
    open.emplace_back(list.begin(), middle);
    open.emplace_back(middle, list.end());
  }
}

}  // namespace

std::vector<Cluster> clusterMesh(const Mesh& mesh, bool separateClosed) {
  const std::vector<Part> parts = connectedParts(mesh);
  std::vector<PartList> groups;
  PartList closed, open;
  for (std::uint32_t p = 0; p < parts.size(); ++p)
    (separateClosed && parts[p].closed ? closed : open).push_back(p);
  splitByGaps(std::move(closed), parts, groups);
  splitByGaps(std::move(open), parts, groups);

  std::vector<Cluster> out;
  for (const PartList& group : groups) {
    Cluster cluster;
    cluster.closed = true;
    for (const std::uint32_t p : group) {
      cluster.triangles.insert(cluster.triangles.end(), parts[p].triangles.begin(), parts[p].triangles.end());
      cluster.closed = cluster.closed && parts[p].closed;
    }
    std::sort(cluster.triangles.begin(), cluster.triangles.end());
    out.push_back(std::move(cluster));
  }
  std::sort(out.begin(), out.end(),
            [](const Cluster& a, const Cluster& b) { return a.triangles.front() < b.triangles.front(); });
  return out;
}

}  // namespace saccade::core
