#include "raytrace/bake/vertex_texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace saccade::raytrace {

int VertexTexels::width() const { return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count)))); }

int VertexTexels::height() const {
  const int w = width();
  return w > 0 ? (static_cast<int>(count) + w - 1) / w : 0;
}

VertexTexels vertexTexels(const core::Mesh& mesh) {
  using Key = std::array<float, 6>;
  const auto keyOf = [&](std::uint32_t v) {
    const core::Vec3 p = mesh.positions[v], n = mesh.normals.empty() ? core::Vec3(0) : mesh.normals[v];
    return Key{p.x, p.y, p.z, n.x, n.y, n.z};
  };
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keyOf(a) < keyOf(b); });
  std::vector<std::uint32_t> first(order.size());  // of the vertices alike, the first
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && keyOf(order[i]) == keyOf(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  VertexTexels out;
  out.numberOf.resize(order.size());
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    out.numberOf[v] = first[v] == v ? static_cast<std::uint32_t>(out.count++) : out.numberOf[first[v]];
  }
  return out;
}

}  // namespace saccade::raytrace
