#include "raytrace/bake/vertex_rings.h"

#include <algorithm>
#include <utility>

#include "raytrace/bake/charts.h"
#include "raytrace/bake/density_window.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/microfacet.h"

namespace saccade::raytrace {
namespace {

/// Rings hold about 3 r^2 vertices: wider ones would take longer than the rays.
constexpr int kMostRings = 16;
constexpr std::size_t kBatch = 1024;  // vertices per piece of work

/// The vertices around one, ring by ring.
class Rings {
 public:
  Rings(const VertexGraph& graph, std::size_t texelCount) : graph_(graph), seen_(texelCount, 0) {}

  void start(std::uint32_t texel) {
    reached_.assign(1, texel);
    seen_[texel] = ++stamp_;
    ring_ = 0;
  }
  /// One ring more; false when there is none.
  bool grow() {
    const std::size_t end = reached_.size();
    for (std::size_t i = ring_; i < end; ++i) {
      for (const std::uint32_t n : graph_.neighbours(reached_[i])) {
        if (std::exchange(seen_[n], stamp_) != stamp_) reached_.push_back(n);
      }
    }
    ring_ = end;
    return reached_.size() > end;
  }
  std::span<const std::uint32_t> reached() const { return reached_; }
  /// What the last grow() added.
  std::span<const std::uint32_t> ring() const { return reached().subspan(ring_); }

 private:
  const VertexGraph& graph_;
  std::vector<std::uint32_t> seen_, reached_;  ///< seen_: by texel, the start that met it last
  std::uint32_t stamp_ = 0;
  std::size_t ring_ = 0;
};

/// Of the widths chosen at a vertex and its neighbours.
std::uint8_t medianRadius(const VertexGraph& graph, std::span<const float> areas,
                          const std::vector<std::uint8_t>& chosen, std::uint32_t vertex) {
  std::vector<std::uint8_t> near{chosen[vertex]};
  for (const std::uint32_t n : graph.neighbours(vertex)) {
    if (areas[n] > 0) near.push_back(chosen[n]);
  }
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return *middle;
}

class VertexDensity {
 public:
  VertexDensity(const VertexGraph& graph, std::span<const float> areas, const FluxGrid& flux, int plane,
                const DensityOptions& options)
      : graph_(graph), areas_(areas), flux_(flux), plane_(plane), options_(options) {}

  std::uint8_t chooseRadius(Rings& rings, std::uint32_t texel) const {
    WindowSum pool = sumOf(texel);
    rings.start(texel);
    for (int r = 0; r < options_.pooledRadius && rings.grow(); ++r) add(rings.ring(), pool);
    rings.start(texel);
    WindowRule rule(options_);
    WindowSum sum = sumOf(texel);
    int reached = 0;
    std::uint8_t best = 0;
    for (std::uint8_t i = 0; i < kRadii.size() && kRadii[i] <= std::min(options_.maxRadius, kMostRings);
         ++i) {
      bool grown = true;
      for (; grown && reached < kRadii[i]; ++reached) {
        grown = rings.grow();
        add(rings.ring(), sum);
      }
      WindowSum window = sum;
      if (kRadii[i] < options_.pooledRadius)
        window.squared = std::max(window.squared, pool.squared * window.area / pool.area);
      if (!rule.takes(window)) break;
      best = i;
      if (rule.suffices(window) || !grown) break;
    }
    return best;
  }

  DensityEstimate estimate(Rings& rings, std::uint32_t texel, int radius, double watts) const {
    rings.start(texel);
    for (int r = 0; r < radius && rings.grow();) ++r;
    WindowSum whole;
    double reach = 0;
    for (const std::uint32_t t : rings.reached()) {
      if (!(areas_[t] > 0)) continue;
      whole += sumOf(t);
      reach = std::max<double>(reach, glm::distance(graph_.position(t), graph_.position(texel)));
    }
    const glm::dvec3 density = whole.weight / whole.area;
    if (radius == 0 || !(whole.effectiveCount() > kFew) || !(reach > 0))
      return estimateOf(whole, density, watts);
    const Frame tangent(graph_.normal(texel));
    LocalPlane plane;
    for (const std::uint32_t t : rings.reached()) {
      if (!(areas_[t] > 0)) continue;
      const Vec3 away = (graph_.position(t) - graph_.position(texel)) / static_cast<float>(reach);
      plane.add(sumOf(t), {glm::dot(away, tangent.t), glm::dot(away, tangent.b)});
    }
    return estimateOf(whole, plane.center(density), watts);
  }

 private:
  WindowSum sumOf(std::uint32_t texel) const {
    const FluxGrid::Cell& cell = flux_.cell(texel, plane_);
    const auto weight = [](std::uint64_t units) {
      return static_cast<double>(units) / FluxGrid::kUnitsPerWeight;
    };
    return {
        {weight(cell.rgb[0]), weight(cell.rgb[1]), weight(cell.rgb[2])}, weight(cell.squared), areas_[texel]};
  }
  void add(std::span<const std::uint32_t> texels, WindowSum& sum) const {
    for (const std::uint32_t t : texels) {
      if (areas_[t] > 0) sum += sumOf(t);
    }
  }

  const VertexGraph& graph_;
  std::span<const float> areas_;
  const FluxGrid& flux_;
  int plane_;
  const DensityOptions& options_;
};

}  // namespace

VertexGraph::VertexGraph(const TexelMap& texels) {
  const core::Scene& scene = texels.scene();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (scene.meshOf(scene.objects[o]).vertexLit) addObject(texels, o, edges);
  }
  if (edges.empty()) return;
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  first_.assign(texels.texelCount() + 1, 0);
  for (const auto& [from, to] : edges) {
    ++first_[from + 1];
    neighbours_.push_back(to);
    if (vertices_.empty() || vertices_.back() != from) vertices_.push_back(from);
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

void VertexGraph::addObject(const TexelMap& texels, std::size_t o,
                            std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges) {
  const core::Object& object = texels.scene().objects[o];
  const core::Mesh& mesh = texels.scene().meshOf(object);
  const glm::mat3 toWorldNormal = glm::transpose(glm::inverse(glm::mat3(object.meshToWorld)));
  places_.resize(texels.texelCount());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    std::uint32_t texel[3];
    for (std::size_t k = 0; k < 3; ++k) texel[k] = texels.vertexTexel(o, 3 * t + k);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = texel[k], b = texel[(k + 1) % 3];
      if (a != b) edges.insert(edges.end(), {{a, b}, {b, a}});
      const std::uint32_t v = mesh.indices[3 * t + k];
      places_[a].position = Vec3(object.meshToWorld * core::Vec4(mesh.positions[v], 1));
      if (!mesh.normals.empty()) places_[a].normal = glm::normalize(toWorldNormal * mesh.normals[v]);
    }
  }
}

void estimateByVertex(const TexelMap& texels, std::span<const float> areas, const FluxGrid& flux, int plane,
                      double watts, const DensityOptions& options, const core::Progress& progress,
                      std::span<DensityEstimate> out) {
  const VertexGraph graph(texels);
  const std::vector<std::uint32_t>& vertices = graph.vertices();
  if (vertices.empty()) return;
  const VertexDensity density(graph, areas, flux, plane, options);
  std::vector<std::uint8_t> chosen(texels.texelCount(), 0);
  const auto forEachVertex = [&](auto&& visit) {
    const std::size_t batches = (vertices.size() + kBatch - 1) / kBatch;
    parallelFor(options.threads, batches, {{}, progress.stop}, {}, [&](std::size_t batch) {
      Rings rings(graph, texels.texelCount());
      const std::size_t end = std::min(vertices.size(), (batch + 1) * kBatch);
      for (std::size_t i = batch * kBatch; i < end; ++i) {
        if (areas[vertices[i]] > 0) visit(rings, vertices[i]);
      }
    });
  };
  forEachVertex([&](Rings& rings, std::uint32_t v) { chosen[v] = density.chooseRadius(rings, v); });
  forEachVertex([&](Rings& rings, std::uint32_t v) {
    out[v] = density.estimate(rings, v, kRadii[medianRadius(graph, areas, chosen, v)], watts);
  });
}

}  // namespace saccade::raytrace
