// The list of experiments: one line each, in the order in which they run.
#include "bench/harness/experiment.h"

namespace saccade::bench {

const std::vector<Experiment>& allExperiments() {
  static const std::vector<Experiment> experiments{};
  return experiments;
}

}  // namespace saccade::bench
