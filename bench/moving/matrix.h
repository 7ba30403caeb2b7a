// Which methods walk under which budgets. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench/harness/experiment.h"
#include "bench/harness/method.h"

namespace saccade::bench {

/// What the frame is compared by: the paper's method as it runs by default.
inline constexpr const char* kMainMethod = "corrective-attention";

/// Milliseconds a frame.
std::vector<double> movingBudgets(Suite suite);

/// The methods that have frames in a budget, among those that --method leaves: main variants at every budget
/// of the suite, the others (orders, weights) at 16 and 33 ms; full: all at all. raytrace and path do not
/// follow budgets and are not among them.
std::vector<Method> movingMethods(const BenchOptions& options, double budgetMs);

/// raytrace and path, whose frames take what they take. None in the quick suite.
std::vector<Method> unbudgetedMethods(const BenchOptions& options);

}  // namespace saccade::bench
