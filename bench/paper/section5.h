// Haber et al. 2001, "Perceptually Guided Corrective Splatting", section 5, row by row.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a row, "paper/ROW": ours, the paper's (median = the middle of its range) and ours over the
/// paper's. The hall has 97,356 triangles, the paper's scene about 90,000; 512x512 as there.
void measureSection5(Session& session);

}  // namespace saccade::bench
