// Charts whose texels are fine where direct light varies: the atlas of a bake.
#pragma once

#include <memory>
#include <string>

#include "core/progress.h"
#include "raytrace/bake/charts.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct LightChartOptions {
  std::string quality = "medium";  ///< a name of quality.h
  std::uint32_t seed = 1;
  int threads = 0;          ///< 0 = inline; changes nothing of the result
  bool vertexLight = true;  ///< dense meshes may keep their light by vertex (ChartLayout)
};

/// Most texels, a layer, of blocks of finer ones where light steps (BakeOptions::detailTexels): what the
/// quality wants of what the plan leaves beside an atlas of this size. Throws core::UsageError.
std::size_t detailTexelsOf(const std::string& quality, const core::Plan& plan, int atlasSize);

struct LightCharts {
  ChartAtlas atlas;
  float finestMetres = 0, coarsestMetres = 0;  ///< texel sides chosen
  /// Expected from texels alone: root mean square of direct light's error over its mean.
  double relativeError = 0;
  std::unique_ptr<World> world;  ///< of the charted scene
};

/// Cuts the charts of a loaded scene, applies them (core::applyCharts), builds its world, measures there how
/// light varies (light_variation.h) and gives each chart texels accordingly (texel_density.h), within
/// plan.lightmapSize squared: their sides lie between plan.finestTexel and plan.coarsestTexel or a part of
/// that by quality. Throws core::UsageError for an unknown quality, core::Error when even one texel a chart
/// does not fit, or when stopped.
LightCharts chartByLight(core::Scene& scene, const core::Plan& plan, const LightChartOptions& options,
                         const core::Progress& progress);

}  // namespace saccade::raytrace
