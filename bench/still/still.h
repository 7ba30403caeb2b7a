// Experiments on still views; see docs/benchmarks.md for what their records hold.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// "reference": the references themselves and their own estimated errors, the floor of everything measured
/// against them. Keys reference/SCENE.
void runReferences(Session& session);

/// "still": error against seconds of every method. Keys still/SCENE/METHOD@SETTING, for example
/// still/cornell/corrective-attention@125ms. Points that not every repeat reached are left out.
void runStill(Session& session);

}  // namespace saccade::bench
