// How good is the picture while the camera moves, at 8 to 125 ms a frame, and are the deadlines kept?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// Every scene of the suite (--scene: those), method and budget: errors of what is displayed at key views
/// against path-traced references, FLIP between consecutive frames, frame times, rates. Records:
/// "moving/SCENE/reference": the references' own error (over key views);
/// "moving/SCENE/METHOD@BUDGETms": five walks each, in alternating order of methods;
/// "moving/SCENE/METHOD" for raytrace and path;
/// "moving/SCENE/against@BUDGETms": kMainMethod's flip and flip_salient over those of each other method, walk
/// by walk.
void measureMoving(Session& session);

}  // namespace saccade::bench
