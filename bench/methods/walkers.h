// The methods on a moving camera. What a walker needs once (memory, threads, shaders) happens before or in
// its first frame; measure from the second on. Main thread only, which the caller keeps
// `Pinned(mainCores())`.
#pragma once

#include <memory>

#include "attention/importance.h"
#include "bench/harness/method.h"

namespace saccade::bench {

/// The illumination maps alone: draw, read-back, display transform. Waits for no deadline.
std::unique_ptr<Walker> walkBase(Stage& stage, app::ImageSize size);

/// The frame loop. With 0 tracers (Stage::tracers) inline and under its virtual clock: repeats exactly.
/// `reuse` off: every frame starts without the samples of earlier ones.
std::unique_ptr<Walker> walkCorrective(Stage& stage, app::ImageSize size,
                                       const attention::AttentionOptions& attention, bool reuse);

/// Every correction of every frame, as `render --method raytrace`, on all cores. Takes what it takes.
std::unique_ptr<Walker> walkRaytrace(Stage& stage, app::ImageSize size);

/// One path a pixel and frame, as `render --method path --spp 1`, on all cores. Takes what it takes.
std::unique_ptr<Walker> walkPath(Stage& stage, app::ImageSize size);

}  // namespace saccade::bench
