// The methods on a still view: each gives pictures, cheapest first, and the seconds from nothing to the
// picture that a person would see. The clock starts where scene, maps, world and GL context are ready and
// ends with the 8-bit picture; every point starts anew, with an empty cache and, for the frame loop, threads
// that wait. Main thread only.
#pragma once

#include <functional>

#include "attention/importance.h"
#include "bench/harness/method.h"

namespace saccade::bench {

using TakePoint = std::function<void(Point)>;

/// The illumination maps alone: one point.
void stillBase(Stage& stage, const StillTask& task, const TakePoint& take);

/// The frame loop under budgets of 8, 16, 33, ... 1000 ms until one converges; with `toTheEnd` then converged
/// with 1, 4, 16, 64 sub-samples a pixel. With 0 tracers (Stage::tracers) inline and under its virtual clock:
/// pictures repeat exactly.
void stillCorrective(Stage& stage, const StillTask& task, const TakePoint& take,
                     const attention::AttentionOptions& attention, bool toTheEnd);

/// The frame loop after its first `samples` samples, or all of them where there are fewer.
Point stillAfterSamples(Stage& stage, const StillTask& task, const attention::AttentionOptions& attention,
                        std::uint64_t samples);

/// Every correction in scanline order on all cores, with 1, 4, 16, 64 sub-samples a pixel.
void stillRaytrace(Stage& stage, const StillTask& task, const TakePoint& take);

/// 1, 2, 4, ... paths a pixel on all cores, without end: StillTask::longestSeconds stops it.
void stillPath(Stage& stage, const StillTask& task, const TakePoint& take);

}  // namespace saccade::bench
