// How do frame time and memory grow?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a point, "growth/QUANTITY/VALUE" (triangles: "growth/triangles/GEOMETRY/VALUE"): the frame
/// without tracing and the peak memory of a process of its own, against triangles, cached samples, objects
/// and pixels, each alone while the others stand at their usual size (FrameSize); against tracer threads, the
/// gallery's frames of 50 ms and the samples that reach them. A point that this machine cannot do is a record
/// with the reason as its label "status".
void measureGrowth(Session& session);

}  // namespace saccade::bench
