// What a change of a scene leaves as it is: charts whose light need not be baked again.
//
// The light of each chart is bounded by how much it can have changed: by way of objects that moved, came,
// went or changed their material, of the lights that stayed (change_bound.h); and by quick bakes of the
// lights that changed, alone (change_scenes.h). A chart is kept where that, and what earlier changes left in
// it, stays below half of the quality's error target (half, since quick looks have errors too); the others
// are baked again.
#pragma once

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include "core/maps.h"
#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "core/scene_state.h"
#include "raytrace/bake/change_scenes.h"
#include "raytrace/bake/kept.h"

namespace saccade::raytrace {

/// The scene that earlier maps were baked for.
struct EarlierScene {
  core::SceneState state;
  double drift = 0;  ///< what texels kept from still earlier states may be off, over mean irradiance
};

struct SceneChange {
  KeptCharts kept;
  std::size_t charts = 0, keptCharts = 0;  ///< that show irradiance
  double drift = 0;                        ///< EarlierScene::drift of the maps that are made so
  double texelShare = 0;                   ///< of the surface's texels that are baked again, [0, 1]
};

/// `scene.now` is charted for an atlas of `size` texels; `inPlace`, by TexelMap::charts(), says which charts
/// have the texels that `previous` holds (empty: all). `previous` must outlive the result. The same for any
/// number of threads. Throws core::Error when stopped.
SceneChange findSceneChange(const ChangedScene& scene, const core::Plan& plan,
                            const core::IlluminationMaps& previous, int size,
                            const std::vector<char>& inPlace, double drift, int threads,
                            const std::stop_token& stop);

}  // namespace saccade::raytrace
