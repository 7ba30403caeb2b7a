// Do aging and warping stay linear in the cached samples, up to a million?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a size, "cache/SAMPLES": aging and warp + splat of the youngest SAMPLES of one long walk
/// through the gallery at 1280x1280 in which nothing leaves by age or angle, in milliseconds and by 1,000
/// samples; the bare warp (bench/cache/bare_warp.h) of the same samples into the same frames, and the ratio
/// of the two. Repeats are medians over the walk's next frames, sizes by turns.
void measureCache(Session& session);

}  // namespace saccade::bench
