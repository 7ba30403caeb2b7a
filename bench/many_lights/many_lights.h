// Many emissive triangles: one light sample's error and cost, by the light tree beside a choice by power
// alone.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record for each number of lamps, "many-lights/LAMPS", in a hall of 40 x 40 m under small lamps of the
/// same power that face anywhere.
void measureManyLights(Session& session);

}  // namespace saccade::bench
