#include "raytrace/bake/charts.h"

#include <stb/stb_rect_pack.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "raytrace/bake/chart_clusters.h"

namespace saccade::raytrace {
namespace {

constexpr int kDefaultSize = 1024;
constexpr int kBorder = 1;              // texels around a chart that are its own: two between charts
constexpr double kFirstFill = 0.85;     // share of the atlas that charts could fill at best
constexpr double kCoarsenStep = 1.06;   // texel side grows by this until all fits
constexpr double kWorthDoubling = 2.0;  // coarser than this times the wish: take a larger atlas

struct PlacedChart {
  std::size_t object = 0;  ///< kShared: the texel of all objects that show no irradiance
  Chart chart;
  int width = 0, height = 0;  ///< texels without border
  int x = 0, y = 0;           ///< first own texel
};
constexpr std::size_t kShared = static_cast<std::size_t>(-1);

int texelsFor(double metres, double texel) {
  return static_cast<int>(std::clamp(std::round(metres / texel), 1.0, 1e6));
}

/// Tries to place all charts at this texel side.
bool pack(std::vector<PlacedChart>& charts, double texel, int size) {
  std::vector<stbrp_rect> rects(charts.size());
  double needed = 0;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const glm::dvec2 extent = charts[i].chart.hi - charts[i].chart.lo;
    charts[i].width = texelsFor(extent.x, texel);
    charts[i].height = texelsFor(extent.y, texel);
    if (std::max(charts[i].width, charts[i].height) + 2 * kBorder > size) return false;
    rects[i] = {};
    rects[i].id = static_cast<int>(i);
    rects[i].w = charts[i].width + 2 * kBorder;
    rects[i].h = charts[i].height + 2 * kBorder;
    needed += static_cast<double>(rects[i].w) * rects[i].h;
  }
  if (needed > static_cast<double>(size) * size) return false;
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(size));
  stbrp_context context;
  stbrp_init_target(&context, size, size, nodes.data(), size);
  if (!stbrp_pack_rects(&context, rects.data(), static_cast<int>(rects.size()))) return false;
  for (const stbrp_rect& r : rects) {
    charts[static_cast<std::size_t>(r.id)].x = r.x + kBorder;
    charts[static_cast<std::size_t>(r.id)].y = r.y + kBorder;
  }
  return true;
}

/// Smallest texel side >= wish at which the charts fit; 0 when not even one texel a chart fits.
double packFrom(std::vector<PlacedChart>& charts, double wish, double largestExtent, int size) {
  for (double texel = wish;; texel *= kCoarsenStep) {
    if (pack(charts, texel, size)) return texel;
    if (texel > 2 * largestExtent) return 0;  // every chart is one texel already
  }
}

core::Vec2 atlasUv(const PlacedChart& placed, const core::Vec3& position, int size) {
  const Chart& chart = placed.chart;
  const glm::dvec2 extent = chart.hi - chart.lo;
  const glm::dvec2 q = chart.project(position) - chart.lo;
  const auto texel = [](double at, double whole, int first, int count) {
    const double share = whole > 0 && std::isfinite(at) ? std::clamp(at / whole, 0.0, 1.0) : 0.5;
    return first + share * count;
  };
  return core::Vec2(texel(q.x, extent.x, placed.x, placed.width) / size,
                    texel(q.y, extent.y, placed.y, placed.height) / size);
}

/// Charts of every object that shows irradiance; its total area in m^2.
std::vector<PlacedChart> clusterScene(const core::Scene& scene, double& area) {
  std::vector<PlacedChart> charts;
  bool shared = false;
  area = 0;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const core::Object& object = scene.objects[o];
    if (!showsIrradiance(scene.materials[static_cast<std::size_t>(object.material)])) {
      shared = true;
      continue;
    }
    for (Chart& chart : clusterMesh(scene.meshOf(object))) {
      const glm::dvec2 extent = chart.hi - chart.lo;
      area += extent.x * extent.y;
      charts.push_back({o, std::move(chart), 0, 0, 0, 0});
    }
  }
  if (shared) charts.push_back({kShared, Chart{}, 0, 0, 0, 0});
  return charts;
}

/// New vertices of one object, chart by chart; `cursor` walks the placed charts.
core::ObjectCharts cutObject(const core::Mesh& mesh, const std::vector<PlacedChart>& placed,
                             std::size_t object, std::size_t& cursor, int size) {
  core::ObjectCharts out;
  out.indices.resize(mesh.indices.size());
  std::vector<std::uint32_t> newVertex(mesh.positions.size(), 0);
  std::vector<std::size_t> ownerChart(mesh.positions.size(), kShared);
  for (; cursor < placed.size() && placed[cursor].object == object; ++cursor) {
    for (const std::uint32_t t : placed[cursor].chart.triangles) {
      for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
        const std::uint32_t v = mesh.indices[c];
        if (ownerChart[v] != cursor) {
          ownerChart[v] = cursor;
          newVertex[v] = static_cast<std::uint32_t>(out.sourceVertex.size());
          out.sourceVertex.push_back(v);
          out.uv.push_back(atlasUv(placed[cursor], mesh.positions[v], size));
        }
        out.indices[c] = newVertex[v];
      }
    }
  }
  return out;
}

/// An object that shows no irradiance keeps its vertices; all lie at the centre of the shared texel.
core::ObjectCharts shareTexel(const core::Mesh& mesh, const PlacedChart& shared, int size) {
  core::ObjectCharts out;
  out.sourceVertex.resize(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) out.sourceVertex[v] = static_cast<std::uint32_t>(v);
  out.uv.assign(mesh.positions.size(),
                core::Vec2(shared.x + 0.5f, shared.y + 0.5f) / static_cast<float>(size));
  out.indices = mesh.indices;
  return out;
}

/// Packs into the planned atlas, or a doubled one; sets out.size and out.texelMetres.
void chooseSize(ChartAtlas& out, std::vector<PlacedChart>& placed, double area, const core::Plan& plan,
                int maxAtlasSize) {
  double largest = 0;
  for (const PlacedChart& p : placed) {
    largest = std::max({largest, p.chart.hi.x - p.chart.lo.x, p.chart.hi.y - p.chart.lo.y});
  }
  out.size =
      std::clamp(plan.lightmapSize > 0 ? plan.lightmapSize : kDefaultSize, 1, std::max(maxAtlasSize, 1));
  for (;; out.size = std::min(2 * out.size, maxAtlasSize)) {
    const double fits = std::sqrt(area / (kFirstFill * out.size * static_cast<double>(out.size)));
    const double wish = std::max({static_cast<double>(plan.texelSizeMetres), fits, 1e-9});
    const double texel = packFrom(placed, wish, largest, out.size);
    out.texelMetres = static_cast<float>(texel);
    if (texel > 0 && (texel <= kWorthDoubling * wish || out.size >= maxAtlasSize)) return;
    if (out.size >= maxAtlasSize) {
      throw core::Error("illumination maps: " + std::to_string(placed.size()) +
                        " charts do not fit an atlas of " + std::to_string(maxAtlasSize) + " x " +
                        std::to_string(maxAtlasSize) +
                        " texels; join vertices of the scene's meshes or allow a larger atlas");
    }
  }
}

}  // namespace

bool showsIrradiance(const core::Material& m) {
  const bool metal = m.metallic >= 1 && !m.metallicRoughnessTexture;
  const bool clear = m.transmission >= 1 && !m.transmissionTexture;
  const bool black = m.baseColor.x <= 0 && m.baseColor.y <= 0 && m.baseColor.z <= 0;
  return !(m.unlit || metal || clear || black);
}

ChartAtlas makeCharts(const core::Scene& scene, const core::Plan& plan, int maxAtlasSize) {
  double area = 0;
  std::vector<PlacedChart> placed = clusterScene(scene, area);
  ChartAtlas out;
  out.chartCount = placed.size();
  chooseSize(out, placed, area, plan, maxAtlasSize);
  std::size_t cursor = 0;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const core::Object& object = scene.objects[o];
    const bool lit = showsIrradiance(scene.materials[static_cast<std::size_t>(object.material)]);
    out.charts.push_back(lit ? cutObject(scene.meshOf(object), placed, o, cursor, out.size)
                             : shareTexel(scene.meshOf(object), placed.back(), out.size));
  }
  return out;
}

}  // namespace saccade::raytrace
