#include "raytrace/bake/charts.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "raytrace/bake/chart_layout.h"

namespace saccade::raytrace {
namespace {

constexpr int kDefaultSize = 1024;
constexpr double kFirstFill = 0.85;     // share of the atlas that charts could fill at best
constexpr double kCoarsenStep = 1.06;   // texel side grows by this until all fits
constexpr double kWorthDoubling = 2.0;  // coarser than this times the wish: take a larger atlas

int plannedSize(const core::Plan& plan) { return plan.lightmapSize > 0 ? plan.lightmapSize : kDefaultSize; }

/// Smallest texel side >= wish at which everything fits; 0 when not even one texel a chart fits.
double packFrom(ChartLayout& layout, double wish, int size) {
  double largest = 0;
  for (const LayoutItem& item : layout.items()) largest = std::max(largest, item.largestExtent);
  for (double texel = wish;; texel *= kCoarsenStep) {
    if (layout.pack(std::vector<double>(layout.items().size(), texel), size)) return texel;
    if (texel > 2 * largest) return 0;  // every chart is one texel already
  }
}

/// Packs into the planned atlas, or a doubled one; sets out.size and out.texelMetres.
void chooseSize(ChartAtlas& out, ChartLayout& layout, const core::Plan& plan, int maxAtlasSize) {
  double area = 0;
  for (const LayoutItem& item : layout.items()) area += item.rectangle;
  out.size = std::clamp(plannedSize(plan), 1, std::max(maxAtlasSize, 1));
  for (;; out.size = std::min(2 * out.size, maxAtlasSize)) {
    const double fits = std::sqrt(area / (kFirstFill * out.size * static_cast<double>(out.size)));
    const double wish = std::max(fits, 1e-9);
    const double texel = packFrom(layout, wish, out.size);
    out.texelMetres = static_cast<float>(texel);
    if (texel > 0 && (texel <= kWorthDoubling * wish || out.size >= maxAtlasSize)) return;
    if (out.size >= maxAtlasSize) {
      throw core::Error("illumination maps: " + std::to_string(layout.chartCount()) +
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
  const double side = std::min(plannedSize(plan), std::max(maxAtlasSize, 1));
  ChartLayout layout(scene, side * side);
  ChartAtlas out;
  out.chartCount = layout.chartCount();
  out.ownAtlases = layout.ownAtlases();
  chooseSize(out, layout, plan, maxAtlasSize);
  out.charts = layout.cut(out.size);
  return out;
}

}  // namespace saccade::raytrace
