// What a change of lights leaves as it is: charts whose light need not be baked again.
//
// Light adds up: the maps of the old lights and those of the new ones differ by the maps of the lights that
// changed, alone. A quick bake of a scene in which only these shine, by as much as they changed, bounds the
// change of every texel. A chart is kept where that, and what earlier changes left in it, stays below half of
// the error target (half, since the quick bake has errors too); the others are baked again.
#pragma once

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include "core/light_state.h"
#include "core/maps.h"
#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "raytrace/bake/kept.h"

namespace saccade::raytrace {

/// Root mean square error over mean irradiance that a quality stands for. Throws core::UsageError.
double errorTargetOf(const std::string& quality);

/// The lights that earlier maps were baked for.
struct EarlierLight {
  core::LightState state;
  double drift = 0;  ///< what texels kept from still earlier lights may be off, over mean irradiance
};

struct LightChange {
  std::vector<std::string> names;  ///< of lights, and of objects whose emission changed
  KeptCharts kept;
  std::size_t charts = 0, keptCharts = 0;  ///< that show irradiance
  double drift = 0;                        ///< EarlierLight::drift of the maps that are made so
  double texelShare = 0;                   ///< of the surface's texels that are baked again, [0, 1]
};

/// `charted` is the scene as it is now, cut by the charts of `previous`, which were baked for another state
/// of its lights: before.state.unlitKey must equal that of `charted`. `previous` must outlive the result. The
/// same for any number of threads. Throws core::Error when stopped.
LightChange findLightChange(const core::Scene& charted, const core::Plan& plan,
                            const core::IlluminationMaps& previous, const EarlierLight& before, int threads,
                            const std::stop_token& stop);

}  // namespace saccade::raytrace
