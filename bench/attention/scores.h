// Scores of saliency models on photographs with recorded fixations.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// "max, orientation" is "max-orientation".
std::string keyOf(const std::string& model);

/// Of the shared folder's photographs, all of them and in two halves (every other one); says so where they
/// are absent. Deterministic.
void scoreModels(Session& session);

}  // namespace saccade::bench
