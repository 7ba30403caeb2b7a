// Is the frame without tracing at most half as long again as its bare draw?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record, "untraced/gallery": the bare draw (OpenGL until it has finished), the frame without tracing
/// (draw, read-back, aging, warp, splat, composite) with 50,000 cached samples as a walk leaves them, stage
/// by stage, and frame over draw. Repeats are passes along the path, by turns.
void measureUntraced(Session& session);

}  // namespace saccade::bench
