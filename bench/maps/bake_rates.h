// How much of bare Embree's speed is left in the stages of a bake?
#pragma once

#include <string>

#include "app/session/workspace.h"
#include "bench/harness/experiment.h"

namespace saccade::bench {

/// Records "maps/SCENE/rate-particles", "rate-direct" and "rate-gather" (final gathering): what one pinned
/// core does a second of each stage (particles, texels), its rays a second and those of a bare rtcIntersect1
/// / rtcOccluded1 loop that replays the very same rays in the same order. `opened` has maps.
void measureBakeRates(Session& session, const std::string& scene, const app::Workspace& opened);

}  // namespace saccade::bench
