#include "raytrace/bake/light_charts.h"

#include <algorithm>
#include <cmath>

#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/light_variation.h"
#include "raytrace/bake/quality.h"
#include "raytrace/bake/texel_density.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {
namespace {

constexpr double kTexelsPerChart = 64;
constexpr int kProbeSize = 512;           // atlas side of the even charts in which light is measured
constexpr double kProbeFill = 0.8;        // of it
constexpr double kProbeTexels = 1 << 20;  // the middle distance of a probe: texels of an atlas of so many
constexpr int kSizeStep = 64;             // atlas sides are multiples of it
constexpr double kMostFill = 0.95;        // a packing's at best
constexpr double kLayoutDone = 0.4;       // of the progress, when charts are cut
constexpr double kWorldDone = 0.6;        // and when rays can be traced

/// Packs into the smallest atlas that holds it, not larger than `largest`; 0 when that does not.
int packSmallest(ChartLayout& layout, const std::vector<double>& texelMetres, int largest,
                 const std::stop_token& stop) {
  const double side = std::sqrt(layout.texelCount(texelMetres) / kMostFill);
  int size = static_cast<int>(std::ceil(std::clamp(side / kSizeStep, 1.0, 1e5))) * kSizeStep;
  for (;; size += kSizeStep) {
    core::throwIfStopped(stop);
    if (layout.pack(texelMetres, std::min(size, largest))) return std::min(size, largest);
    if (size >= largest) return 0;
  }
}

/// Some rectangle has more than one texel yet.
bool canCoarsen(const ChartLayout& layout, const std::vector<double>& texelMetres) {
  for (std::size_t i = 0; i < texelMetres.size(); ++i) {
    if (texelMetres[i] < 2 * layout.items()[i].largestExtent) return true;
  }
  return false;
}

/// Coarsens all texels alike until they fit; returns the atlas side.
int packWithin(ChartLayout& layout, std::vector<double>& texelMetres, int largest,
               const std::stop_token& stop) {
  constexpr double kStep = 1.03;
  for (;;) {
    const int size = packSmallest(layout, texelMetres, largest, stop);
    if (size > 0) return size;
    if (!canCoarsen(layout, texelMetres)) {
      throw core::Error("illumination maps: " + std::to_string(layout.chartCount()) +
                        " charts do not fit an atlas of " + std::to_string(largest) + " x " +
                        std::to_string(largest) +
                        " texels; join vertices of the scene's meshes or allow more with --maps-mb");
    }
    for (double& h : texelMetres) h *= kStep;
  }
}

double rectangleOf(const ChartLayout& layout) {
  double sum = 0;
  for (const LayoutItem& item : layout.items()) sum += item.rectangle;
  return sum;
}

VariationOptions probesOf(const ChartLayout& layout, const LightChartOptions& options) {
  VariationOptions probes;
  const double middle = std::sqrt(rectangleOf(layout) / kProbeTexels);
  probes.metres = {4 * middle, middle, middle / 4};
  probes.seed = options.seed;
  probes.threads = options.threads;
  return probes;
}

}  // namespace

std::size_t detailTexelsOf(const std::string& quality, const core::Plan& plan, int atlasSize) {
  // A texel of the atlas that may have a block takes 4 bytes more than the 6 of its light.
  constexpr double kAtlasTexel = 5.0 / 3;
  const double left = static_cast<double>(plan.lightmapSize) * plan.lightmapSize -
                      kAtlasTexel * atlasSize * static_cast<double>(atlasSize);
  return static_cast<std::size_t>(std::clamp(left, 0.0, qualityOf(quality).detailTexels));
}

LightCharts chartByLight(core::Scene& scene, const core::Plan& plan, const LightChartOptions& options,
                         const core::Progress& progress) {
  const Quality& wish = qualityOf(options.quality);
  const int largest = plan.lightmapSize > 0 ? plan.lightmapSize : kProbeSize;
  const double mostOfPlan = kMostFill * largest * largest;
  const bool mayByVertex = options.vertexLight && plan.denseMeshes > 0;
  ChartLayout layout(scene, std::min(wish.texels, mostOfPlan),
                     mayByVertex ? VertexLight::whereItPays : VertexLight::never,
                     wish.texels + wish.detailTexels, progress.part(0, kLayoutDone));
  // Many small charts are not to share one texel each.
  const double mostTexels =
      std::min(std::max(wish.texels, kTexelsPerChart * static_cast<double>(layout.chartCount())), mostOfPlan);
  const double even = std::max(std::sqrt(rectangleOf(layout) / kProbeFill) / kProbeSize, 1e-9);
  std::vector<double> sides(layout.items().size(), even);
  LightCharts out;
  out.atlas.chartCount = layout.chartCount();
  out.atlas.ownAtlases = layout.ownAtlases();
  out.atlas.vertexLitMeshes = layout.vertexLitMeshes();
  const int probeSize = packWithin(layout, sides, largest, progress.stop);
  out.atlas.charts = layout.cut(probeSize);
  core::applyCharts(scene, out.atlas.charts);
  out.world = std::make_unique<World>(scene, plan, progress.part(kLayoutDone, kWorldDone));

  const VariationOptions probes = probesOf(layout, options);
  const TexelMap texels(scene, probeSize);
  const std::vector<LightVariation> variation =
      measureVariation(*out.world, texels, layout, probes, progress.part(kWorldDone, 1));
  DensityGoal goal;
  goal.relativeError = wish.texelError;
  goal.mostTexels = mostTexels;
  goal.coarsest = plan.coarsestTexel > 0 ? wish.coarsest * static_cast<double>(plan.coarsestTexel) : even;
  // What blocks can do the atlas need not: a single thin chart of fine texels would empty most of it.
  constexpr double kFinestBesideBlocks = 1.0 / 8;
  goal.finest = std::max(static_cast<double>(plan.finestTexel),
                         wish.detailTexels > 0 ? goal.coarsest * kFinestBesideBlocks : 0);
  DensityChoice choice = chooseDensity(layout, variation, probes.metres, goal);
  out.relativeError = choice.relativeError;
  out.atlas.size = packWithin(layout, choice.texelMetres, largest, progress.stop);
  if (!choice.texelMetres.empty()) {
    const auto [finest, coarsest] = std::minmax_element(choice.texelMetres.begin(), choice.texelMetres.end());
    out.finestMetres = static_cast<float>(*finest);
    out.coarsestMetres = static_cast<float>(*coarsest);
  }
  out.atlas.texelMetres = out.coarsestMetres;
  core::SceneCharts placed = layout.cut(out.atlas.size);
  for (std::size_t m = 0; m < placed.meshes.size(); ++m)
    out.atlas.charts.meshes[m].uv = std::move(placed.meshes[m].uv);
  out.atlas.charts.places = std::move(placed.places);
  core::placeCharts(scene, out.atlas.charts);
  out.world->refreshCharts();
  return out;
}

}  // namespace saccade::raytrace
