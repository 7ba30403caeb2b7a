#include "bench/harness/trials.h"

#include "core/error.h"

namespace saccade::bench {

void alternate(int variants, int rounds, const std::stop_token& stop,
               const std::function<void(int variant, int round)>& measure) {
  for (int round = -1; round < rounds; ++round) {
    for (int i = 0; i < variants; ++i) {
      if (stop.stop_requested()) throw core::Error("stopped on request");
      measure(round % 2 == 0 ? i : variants - 1 - i, round);
    }
  }
}

std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b) {
  assert(a.size() == b.size());
  std::vector<double> result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(a[i] / b[i]);
  return result;
}

}  // namespace saccade::bench
