// The list of experiments: one line each, in the order in which they run.
#include "bench/harness/experiment.h"
#include "bench/load/load.h"
#include "bench/many_lights/many_lights.h"
#include "bench/rays/rays.h"

namespace saccade::bench {

const std::vector<Experiment>& allExperiments() {
  static const std::vector<Experiment> experiments{
      {"rays",
       "How much of bare Embree's speed is left in the corrective loop?",
       {Suite::quick},
       &measureRays},
      {"load", "What takes the time from a file to its first frame?", {}, &measureLoad},
      {"many-lights",
       "What does a light sample among many lamps cost, and how far off is it?",
       {Suite::quick},
       &measureManyLights},
  };
  return experiments;
}

}  // namespace saccade::bench
