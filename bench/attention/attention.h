// Experiment `attention`: what the saliency model costs, beside a plain OpenCV version, and how well it
// foretells where people look, beside other models.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

void measureAttention(Session& session);

}  // namespace saccade::bench
