// How soon the window shows a scene.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a scene, "first-frame/SCENE": seconds from the start of `saccade walk SCENE` to the first frame
/// that shows its base layer and to the first that is walked in, and the longest time for which the window
/// looked at no events meanwhile, as the program itself counts them. The real window under the display that
/// DISPLAY names, which may be Xvfb; without one nothing is measured, which is said. Maps (preview) are baked
/// before, and read from the cache.
void measureFirstFrame(Session& session);

}  // namespace saccade::bench
