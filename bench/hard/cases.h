// The numerical hard cases, and what of them waits for a later capability.
#pragma once

#include <string_view>
#include <vector>

namespace saccade::bench {

struct HardCaseTitle {
  int number;  ///< 1 to 28
  std::string_view title;
  std::string_view notBuilt;  ///< clauses that belong to what is not built yet; empty: none
};

/// All 28, in order.
const std::vector<HardCaseTitle>& hardCaseTitles();

}  // namespace saccade::bench
