#include "raytrace/bake/texel_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "core/union_find.h"
#include "raytrace/bake/cell_clip.h"
#include "raytrace/bake/charts.h"

namespace saccade::raytrace {
namespace {

double worldArea(const core::Mesh& mesh, const glm::dmat3& meshToWorld, std::size_t t) {
  const glm::dvec3 a = mesh.positions[mesh.indices[3 * t]];
  const glm::dvec3 b = mesh.positions[mesh.indices[3 * t + 1]];
  const glm::dvec3 c = mesh.positions[mesh.indices[3 * t + 2]];
  return 0.5 * glm::length(glm::cross(meshToWorld * (b - a), meshToWorld * (c - a)));
}

/// In texels of the atlas, with the roundings of the tracer's look-ups.
Plane2 texelPosition(const core::Scene& scene, std::size_t object, std::size_t corner, int size) {
  const core::Object& o = scene.objects[object];
  const core::Mesh& mesh = scene.meshOf(o);
  return Plane2(core::placeInAtlas(o.lightmapScaleOffset, mesh.lightmapUv[mesh.indices[corner]])) *
         static_cast<double>(size);
}

}  // namespace

std::vector<std::int32_t> chartsOfUv(const core::Mesh& mesh, std::span<const core::Vec2> uvs) {
  core::UnionFind parts(mesh.positions.size());
  std::unordered_map<std::uint64_t, std::uint32_t> byUv;
  byUv.reserve(uvs.size());
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    const core::Vec2 uv = uvs[v];
    const std::uint64_t key =
        (std::uint64_t{std::bit_cast<std::uint32_t>(uv.x)} << 32) | std::bit_cast<std::uint32_t>(uv.y);
    const auto self = static_cast<std::uint32_t>(v);
    parts.unite(self, byUv.try_emplace(key, self).first->second);
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    parts.unite(mesh.indices[i], mesh.indices[i + 1]);
    parts.unite(mesh.indices[i], mesh.indices[i + 2]);
  }
  std::vector<std::int32_t> number(mesh.positions.size(), -1), out(mesh.triangleCount());
  std::int32_t next = 0;
  for (std::size_t t = 0; t < out.size(); ++t) {
    std::int32_t& n = number[parts.find(mesh.indices[3 * t])];
    if (n < 0) n = next++;
    out[t] = n;
  }
  return out;
}

TexelMap::TexelMap(const core::Scene& charted, int size) : scene_(charted), size_(size) {
  chartOf_.assign(texelCount(), -1);
  area_.assign(texelCount(), 0.0f);
  findCharts();
  cover();
}

void TexelMap::findCharts() {
  chartOfTriangle_.resize(scene_.meshes.size());
  firstChart_.assign(scene_.objects.size(), kNoCharts);
  for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
    const core::Object& object = scene_.objects[o];
    const core::Material& material = scene_.materials[static_cast<std::size_t>(object.material)];
    if (!showsIrradiance(material)) continue;
    const core::Mesh& mesh = scene_.meshOf(object);
    if (mesh.lightmapUv.size() != mesh.positions.size()) {
      throw core::Error("illumination maps: object '" + object.name +
                        "' has no charts; call applyCharts first");
    }
    std::vector<std::int32_t>& chartOf = chartOfTriangle_[object.mesh];
    if (chartOf.empty()) {
      chartOf = mesh.vertexLit ? std::vector<std::int32_t>(mesh.triangleCount(), 0)
                               : chartsOfUv(mesh, mesh.lightmapUv);
    }
    firstChart_[o] = static_cast<std::int32_t>(charts_.size());
    const std::int32_t count = chartOf.empty() ? 0 : 1 + *std::max_element(chartOf.begin(), chartOf.end());
    charts_.resize(charts_.size() + static_cast<std::size_t>(count),
                   {size_, size_, 0, 0, material.doubleSided, mesh.vertexLit});
    anyDoubleSided_ |= material.doubleSided;
  }
}

std::vector<TexelMap::Placed> TexelMap::placeFragments() const {
  std::vector<Placed> placed;
  for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
    if (firstChart_[o] == kNoCharts) continue;
    const core::Object& object = scene_.objects[o];
    const core::Mesh& mesh = scene_.meshOf(object);
    const glm::dmat3 meshToWorld(object.meshToWorld);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      if (mesh.vertexLit) {
        placeByVertex(o, t, worldArea(mesh, meshToWorld, t), placed);
        continue;
      }
      const Plane2 a = texelPosition(scene_, o, 3 * t, size_), b = texelPosition(scene_, o, 3 * t + 1, size_),
                   c = texelPosition(scene_, o, 3 * t + 2, size_);
      const double whole = 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      const double perCell = whole > 0 ? worldArea(mesh, meshToWorld, t) / whole : 0;
      if (!(perCell > 0) || !std::isfinite(perCell)) continue;
      forEachCell(a, b, c, size_, size_, [&](int x, int y, double cells) {
        const auto area = static_cast<float>(cells * perCell);
        if (!(area > 0)) return;
        placed.push_back({static_cast<std::uint32_t>(y * size_ + x),
                          firstChart_[o] + chartOfTriangle_[object.mesh][t],
                          static_cast<float>(cells),
                          {static_cast<std::uint32_t>(o), static_cast<std::uint32_t>(t), area}});
      });
    }
  }
  return placed;
}

std::uint32_t TexelMap::vertexTexel(std::size_t object, std::size_t corner) const {
  const Plane2 p = texelPosition(scene_, object, corner, size_);
  return static_cast<std::uint32_t>(static_cast<int>(p.y) * size_ + static_cast<int>(p.x));
}

void TexelMap::placeByVertex(std::size_t object, std::size_t triangle, double area,
                             std::vector<Placed>& out) const {
  const auto third = static_cast<float>(area / 3);
  if (!(third > 0) || !std::isfinite(third)) return;
  for (std::size_t k = 0; k < 3; ++k) {
    out.push_back({vertexTexel(object, 3 * triangle + k),
                   firstChart_[object],
                   1,
                   {static_cast<std::uint32_t>(object), static_cast<std::uint32_t>(triangle), third}});
  }
}

void TexelMap::cover() {
  std::vector<Placed> placed = placeFragments();
  std::vector<float> filled(texelCount(), 0.0f);
  for (const Placed& p : placed) filled[p.texel] += p.cells;
  // A chart's border that should end at a texel's edge can cross it by the rounding of its uv. Such a sliver
  // is no texel: its few points would stand for the whole texel in look-ups.
  constexpr float kSliver = 1e-3f;
  std::erase_if(placed, [&](const Placed& p) { return filled[p.texel] < kSliver; });
  std::vector<std::size_t> count(texelCount() + 1, 0);
  for (const Placed& p : placed) {
    const int x = static_cast<int>(p.texel) % size_, y = static_cast<int>(p.texel) / size_;
    ChartRect& rect = charts_[static_cast<std::size_t>(p.chart)];
    rect = {std::min(rect.x0, x),     std::min(rect.y0, y), std::max(rect.x1, x + 1),
            std::max(rect.y1, y + 1), rect.doubleSided,     rect.byVertex};
    ++count[p.texel + 1];
    chartOf_[p.texel] = p.chart;
    area_[p.texel] += p.fragment.area;
  }
  for (std::size_t i = 1; i < count.size(); ++i) count[i] += count[i - 1];
  first_ = count;
  fragments_.resize(placed.size());
  for (const Placed& p : placed) fragments_[count[p.texel]++] = p.fragment;
}

/// The fragment's polygon in the atlas, in texels.
CellPolygon TexelMap::clipped(const TexelFragment& fragment, std::size_t texel) const {
  const std::size_t corner = std::size_t{3} * fragment.triangle;
  return clipToCell(texelPosition(scene_, fragment.object, corner, size_),
                    texelPosition(scene_, fragment.object, corner + 1, size_),
                    texelPosition(scene_, fragment.object, corner + 2, size_),
                    static_cast<int>(texel % static_cast<std::size_t>(size_)),
                    static_cast<int>(texel / static_cast<std::size_t>(size_)));
}

TexelCover TexelMap::coverOf(std::size_t texel) const {
  Plane2 moment(0);
  double twice = 0;
  for (const TexelFragment& f : fragments(texel)) {
    const CellPolygon cell = clipped(f, texel);
    for (int i = 1; i + 1 < cell.count; ++i) {
      const Plane2 e = cell.corner[i] - cell.corner[0], g = cell.corner[i + 1] - cell.corner[0];
      const double area = std::abs(e.x * g.y - e.y * g.x);
      moment += area / 3 * (cell.corner[0] + cell.corner[i] + cell.corner[i + 1]);
      twice += area;
    }
  }
  const int x = static_cast<int>(texel) % size_, y = static_cast<int>(texel) / size_;
  const Plane2 centre(x + 0.5, y + 0.5);
  return {twice > 0 ? moment / twice : centre, 0.5 * twice};
}

/// Two triangles make up the third of a triangle that is its vertex's: (vertex, middle of a side, centroid).
MeshPoint TexelMap::pointByVertex(const TexelFragment& part, std::size_t texel, float v, float w) const {
  std::size_t k = 0;
  while (k < 2 && vertexTexel(part.object, std::size_t{3} * part.triangle + k) != texel) ++k;
  const bool second = v >= 0.5f;
  const float root = std::sqrt(second ? 2 * v - 1 : 2 * v);
  // root * ((1 - w) * middle + w * centroid), from the vertex.
  const float far = root * w / 3, near = far + root * (1 - w) / 2;
  float b[3];
  b[(k + 1) % 3] = second ? far : near;
  b[(k + 2) % 3] = second ? near : far;
  b[k] = 1 - near - far;
  return {part.object, part.triangle, b[1], b[2]};
}

MeshPoint TexelMap::pointOn(std::size_t texel, float u, float v, float w) const {
  const std::span<const TexelFragment> parts = fragments(texel);
  const TexelFragment* part = &parts.front();
  float rest = u * area_[texel];
  for (const TexelFragment& f : parts) {
    part = &f;
    if (rest < f.area) break;
    rest -= f.area;
  }
  if (charts_[static_cast<std::size_t>(chartOf_[texel])].byVertex) return pointByVertex(*part, texel, v, w);
  const std::size_t corner = std::size_t{3} * part->triangle;
  const Plane2 a = texelPosition(scene_, part->object, corner, size_),
               b = texelPosition(scene_, part->object, corner + 1, size_),
               c = texelPosition(scene_, part->object, corner + 2, size_);
  const CellPolygon cell = clipped(*part, texel);
  // Choose a triangle of the polygon's fan by area, then a point in it.
  double target = v * cell.twiceArea(), share = 0;
  int fan = 1;
  for (; fan + 1 < cell.count; ++fan) {
    const Plane2 e = cell.corner[fan] - cell.corner[0], f = cell.corner[fan + 1] - cell.corner[0];
    const double twice = e.x * f.y - e.y * f.x;
    share = twice != 0 ? std::clamp(target / twice, 0.0, 1.0) : 0.5;
    if (std::abs(target) <= std::abs(twice) || fan + 2 >= cell.count) break;
    target -= twice;
  }
  const double root = std::sqrt(share);
  const Plane2 p =
      cell.corner[0] * (1 - root) + (cell.corner[fan] * (1.0 - w) + cell.corner[fan + 1] * double{w}) * root;
  const Plane2 e = b - a, f = c - a, d = p - a;
  const double whole = e.x * f.y - e.y * f.x;
  MeshPoint out{part->object, part->triangle, 0, 0};
  out.b1 = static_cast<float>(std::clamp((d.x * f.y - d.y * f.x) / whole, 0.0, 1.0));
  out.b2 = static_cast<float>(std::clamp((e.x * d.y - e.y * d.x) / whole, 0.0, 1.0 - out.b1));
  return out;
}

std::optional<MeshPoint> TexelMap::pointAt(std::size_t texel, const Plane2& position) const {
  for (const TexelFragment& f : fragments(texel)) {
    const std::size_t corner = std::size_t{3} * f.triangle;
    const Plane2 a = texelPosition(scene_, f.object, corner, size_),
                 e = texelPosition(scene_, f.object, corner + 1, size_) - a,
                 g = texelPosition(scene_, f.object, corner + 2, size_) - a, d = position - a;
    const double whole = e.x * g.y - e.y * g.x;
    const double b1 = (d.x * g.y - d.y * g.x) / whole, b2 = (e.x * d.y - e.y * d.x) / whole;
    if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)
      return MeshPoint{f.object, f.triangle, static_cast<float>(b1), static_cast<float>(b2)};
  }
  return std::nullopt;
}

std::size_t TexelMap::texelAt(const core::Vec2& uv) const {
  const auto clampTexel = [&](float at) { return std::clamp(static_cast<int>(at * size_), 0, size_ - 1); };
  return static_cast<std::size_t>(clampTexel(uv.y)) * size_ + clampTexel(uv.x);
}

}  // namespace saccade::raytrace
