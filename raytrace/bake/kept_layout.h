// The charts of a scene some of whose objects changed: what did not move keeps its texels' places.
//
// The scene is cut as for a new bake. Charts of objects that were there before go back to where they were in
// the earlier atlas; those of the others, and those that now want twice as many texels, take free places
// there, with the texels that the new cut gave them. The atlas grows where they find none.
#pragma once

#include <optional>
#include <vector>

#include "core/maps.h"
#include "core/scene/scene.h"
#include "raytrace/bake/charts.h"
#include "raytrace/bake/scene_match.h"

namespace saccade::raytrace {

struct KeptLayout {
  core::SceneCharts charts;   ///< for core::placeCharts
  int size = 0;               ///< of the atlas; the earlier maps' or larger
  std::vector<char> inPlace;  ///< by TexelMap::charts(): its texels are those of the earlier maps
};

/// `charted` is the scene as cut by `fresh`; `before` and `previous` are the earlier scene's plain objects
/// and maps. None when nothing can keep its place, or when the charts do not fit `largest` texels a side.
std::optional<KeptLayout> keepLayout(const core::Scene& charted, const ChartAtlas& fresh,
                                     const SceneMatch& match, const core::Scene& before,
                                     const core::IlluminationMaps& previous, int largest);

}  // namespace saccade::raytrace
