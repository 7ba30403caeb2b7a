// What light probes are worth where nothing is corrected yet (render/probe), and what they cost.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// The first camera of cornell, table, gallery and the shared glossy room, from a cold start: errors against
/// the converged picture, over the mask alone, of the same frames with and without the approximation.
void measureApproximation(Session& session);

}  // namespace saccade::bench
