// How much of Embree's speed is left in the corrective loop?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a scene, "rays/SCENE": rays per core and second of the corrective loop, shadow rays included,
/// and of a bare rtcIntersect1/rtcOccluded1 loop that replays the very same rays in the same order.
void measureRays(Session& session);

}  // namespace saccade::bench
