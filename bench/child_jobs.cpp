// The measurements that run in processes of their own: one line each.
#include "bench/growth/frame.h"
#include "bench/harness/child.h"
#include "bench/load/load.h"

namespace saccade::bench {

const std::vector<ChildJob>& allChildJobs() {
  static const std::vector<ChildJob> jobs{
      {"parse", &parseFile}, {"load", &loadAndDraw}, {"frame", &frameWithoutTracing}};
  return jobs;
}

}  // namespace saccade::bench
