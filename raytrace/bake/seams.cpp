#include "raytrace/bake/seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "raytrace/bake/charts.h"

namespace saccade::raytrace {
namespace {

constexpr float kCreaseCosine = 0.906f;  // 25 degrees, as in chart_clusters.cpp
constexpr double kPointsPerTexel = 2;
constexpr int kMostSweeps = 64;
constexpr double kAgreed = 2e-4;  // root mean square of the differences over that of the values: stop
constexpr float kStep = 0.25f;    // of the larger value: a difference that may be true

/// An edge of one triangle only, as the charted mesh has it.
struct BorderEdge {
  std::array<core::Vec3, 2> end;  ///< in the world, in ascending order
  std::array<core::Vec3, 2> normal;
  std::array<Plane2, 2> texel;
  bool doubleSided;

  auto key() const { return std::tuple(end[0].x, end[0].y, end[0].z, end[1].x, end[1].y, end[1].z); }
};

/// First corners of the edges that no other triangle of the mesh shares by its vertices.
std::vector<std::size_t> borderCorners(const core::Mesh& mesh) {
  std::vector<std::pair<std::uint64_t, std::size_t>> edges;
  edges.reserve(mesh.indices.size());
  for (std::size_t c = 0; c < mesh.indices.size(); ++c) {
    const std::uint64_t a = mesh.indices[c], b = mesh.indices[c % 3 == 2 ? c - 2 : c + 1];
    edges.emplace_back(std::min(a, b) << 32 | std::max(a, b), c);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::size_t> out;
  for (std::size_t i = 0, j; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && edges[j].first == edges[i].first;) ++j;
    if (j == i + 1) out.push_back(edges[i].second);
  }
  return out;
}

void addBorder(const core::Object& object, const core::Mesh& mesh, std::size_t corner, double size,
               bool doubleSided, std::vector<BorderEdge>& out) {
  const glm::mat3 toWorldNormal = glm::transpose(glm::inverse(glm::mat3(object.meshToWorld)));
  BorderEdge edge;
  edge.doubleSided = doubleSided;
  const std::uint32_t index[2] = {mesh.indices[corner],
                                  mesh.indices[corner % 3 == 2 ? corner - 2 : corner + 1]};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::uint32_t v = index[k];
    edge.end[k] = core::Vec3(object.meshToWorld * core::Vec4(mesh.positions[v], 1)) + 0.0f;  // -0 becomes +0
    edge.normal[k] = mesh.normals.empty() ? core::Vec3(0) : glm::normalize(toWorldNormal * mesh.normals[v]);
    edge.texel[k] = Plane2(core::placeInAtlas(object.lightmapScaleOffset, mesh.lightmapUv[v])) * size;
  }
  const auto order = [](const core::Vec3& p) { return std::tuple(p.x, p.y, p.z); };
  if (!(order(edge.end[0]) < order(edge.end[1]))) {
    if (!(order(edge.end[1]) < order(edge.end[0]))) return;  // no length, or not a number
    std::swap(edge.end[0], edge.end[1]);
    std::swap(edge.normal[0], edge.normal[1]);
    std::swap(edge.texel[0], edge.texel[1]);
  }
  out.push_back(edge);
}

bool smooth(const BorderEdge& a, const BorderEdge& b) {
  return glm::dot(a.normal[0], b.normal[0]) >= kCreaseCosine &&
         glm::dot(a.normal[1], b.normal[1]) >= kCreaseCosine;
}

/// A bilinear look-up: texels and weights.
struct LookUp {
  std::array<std::size_t, 4> at;
  std::array<float, 4> weight;

  LookUp(const Plane2& p, int size) {
    const auto split = [&](double v, int& first) {
      const double x = std::clamp(v - 0.5, 0.0, size - 1.0);
      first = std::min(static_cast<int>(x), std::max(size - 2, 0));
      return static_cast<float>(x - first);
    };
    int x = 0, y = 0;
    const float right = split(p.x, x), down = split(p.y, y);
    const auto stride = static_cast<std::size_t>(size);
    const std::size_t step = size > 1 ? 1 : 0;
    at[0] = static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x);
    at[1] = at[0] + step;
    at[2] = at[0] + step * stride;
    at[3] = at[2] + step;
    weight = {(1 - right) * (1 - down), right * (1 - down), (1 - right) * down, right * down};
  }
  core::Vec3 read(std::span<const core::Vec3> texels) const {
    core::Vec3 sum(0);
    for (std::size_t i = 0; i < 4; ++i) sum += texels[at[i]] * weight[i];
    return sum;
  }
  void add(std::span<core::Vec3> texels, const core::Vec3& change) const {
    for (std::size_t i = 0; i < 4; ++i)
      texels[at[i]] = glm::max(texels[at[i]] + change * weight[i], core::Vec3(0));
  }
  float norm() const {
    float sum = 0;
    for (const float w : weight) sum += w * w;
    return sum;
  }
};

struct SeamPoint {
  LookUp side[2];
  float scale;  ///< of the smallest change that makes the difference 1
};

std::vector<SeamPoint> pointsOf(std::span<const Seam> seams, int size, bool backs) {
  std::vector<SeamPoint> points;
  for (const Seam& seam : seams) {
    if (backs && !seam.doubleSided) continue;
    const double length =
        std::max(glm::length(seam.to[0] - seam.from[0]), glm::length(seam.to[1] - seam.from[1]));
    const int count = static_cast<int>(std::clamp(std::ceil(kPointsPerTexel * length), 1.0, 65536.0));
    for (int i = 0; i < count; ++i) {
      const double s = (i + 0.5) / count;
      const LookUp a(glm::mix(seam.from[0], seam.to[0], s), size),
          b(glm::mix(seam.from[1], seam.to[1], s), size);
      points.push_back({{a, b}, 1 / (a.norm() + b.norm())});
    }
  }
  return points;
}

}  // namespace

std::vector<Seam> findSeams(const TexelMap& texels) {
  const core::Scene& scene = texels.scene();
  std::vector<BorderEdge> edges;
  for (const core::Object& object : scene.objects) {
    const core::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
    if (!showsIrradiance(material)) continue;
    const core::Mesh& mesh = scene.meshOf(object);
    if (mesh.vertexLit) continue;  // its look-ups are not bilinear, and it has no charts
    for (const std::size_t corner : borderCorners(mesh))
      addBorder(object, mesh, corner, texels.size(), material.doubleSided, edges);
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const BorderEdge& a, const BorderEdge& b) { return a.key() < b.key(); });
  std::vector<Seam> seams;
  for (std::size_t i = 0, j; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && edges[j].key() == edges[i].key();) ++j;
    if (j != i + 2 || !smooth(edges[i], edges[i + 1])) continue;
    const BorderEdge &a = edges[i], &b = edges[i + 1];
    seams.push_back({{a.texel[0], b.texel[0]}, {a.texel[1], b.texel[1]}, a.doubleSided && b.doubleSided});
  }
  return seams;
}

void stitchSeams(std::span<const Seam> seams, int size, bool backs, std::span<core::Vec3> irradiance) {
  const std::vector<SeamPoint> points = pointsOf(seams, size, backs);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double differences = 0, values = 0;
    for (const SeamPoint& p : points) {
      const core::Vec3 a = p.side[0].read(irradiance), b = p.side[1].read(irradiance), difference = a - b;
      const float ya = core::luminance(a), yb = core::luminance(b);
      if (!(std::abs(ya - yb) <= kStep * std::max(ya, yb))) continue;
      differences += double{ya - yb} * (ya - yb);
      values += double{ya} * yb;
      p.side[0].add(irradiance, -difference * p.scale);
      p.side[1].add(irradiance, difference * p.scale);
    }
    if (differences <= kAgreed * kAgreed * values) break;
  }
}

}  // namespace saccade::raytrace
