#include "bench/moving/matrix.h"

#include <algorithm>
#include <set>

namespace saccade::bench {
namespace {

const std::vector<double> kBudgetsMs = {8, 16, 33, 66, 125};
const std::vector<double> kQuickBudgetsMs = {16, 66};
/// For orders and weights: with 66 ms the hall at 256x256 is exact in every frame, whatever the order.
const std::vector<double> kOrderBudgetsMs = {16, 33};
const std::set<std::string> kMainVariants = {"base", kMainMethod, "corrective-attention-nocache"};
const std::set<std::string> kUnbudgeted = {"raytrace", "path"};

bool among(const std::vector<double>& budgets, double budget) {
  return std::find(budgets.begin(), budgets.end(), budget) != budgets.end();
}

bool wanted(const Method& method, Suite suite, double budgetMs) {
  if (suite == Suite::full || kMainVariants.count(method.key()) > 0) return true;
  return suite != Suite::quick && method.labels.at("cache") == "on" && among(kOrderBudgetsMs, budgetMs);
}

}  // namespace

std::vector<double> movingBudgets(Suite suite) {
  return suite == Suite::quick ? kQuickBudgetsMs : kBudgetsMs;
}

std::vector<Method> movingMethods(const BenchOptions& options, double budgetMs) {
  std::vector<Method> methods = allMethods();
  std::erase_if(methods, [&](const Method& m) {
    return !m.walk || kUnbudgeted.count(m.name) > 0 || !options.wantsMethod(m.name) ||
           !wanted(m, options.suite, budgetMs);
  });
  return methods;
}

std::vector<Method> unbudgetedMethods(const BenchOptions& options) {
  std::vector<Method> methods = allMethods();
  std::erase_if(methods, [&](const Method& m) {
    return !m.walk || kUnbudgeted.count(m.name) == 0 || !options.wantsMethod(m.name) ||
           options.suite == Suite::quick;
  });
  return methods;
}

}  // namespace saccade::bench
