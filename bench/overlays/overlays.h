// What an overlay costs a frame in the window.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// The gallery at 512 x 512 along its path with 5,000 new samples a frame, then at rest; the time from a
/// frame's picture to the same with the overlay over it.
///
/// "overlays/NAME": moving_ms and rest_ms, a frame each.
void measureOverlays(Session& session);

}  // namespace saccade::bench
