// The ray-traced reference: every non-diffuse pixel in scanline order; no queues, no splats, no levels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/corrective/messages.h"
#include "core/progress.h"
#include "raytrace/corrective_tracer.h"

namespace saccade::raytrace {

struct TraceAllResult {
  std::vector<core::Vec4> corrections;  ///< width * height, w = 1 where traced, else 0
  std::uint64_t traced = 0;
  std::uint64_t fromDepth = 0;
  RayCounters counters;
};

/// `threads` 0 = on the calling thread. The same for any number of threads. Throws core::Error when stopped.
TraceAllResult traceAll(const CorrectiveTracer& tracer, const core::FrameSnapshot& frame, int threads,
                        const core::Progress& progress);

}  // namespace saccade::raytrace
