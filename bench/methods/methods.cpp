// The list of methods. A later capability adds its rows here.
#include "bench/harness/method.h"

namespace saccade::bench {
namespace {

/// Order, cache and attention of a corrective variant, as its labels and its key say them.
Method corrective(const std::string& order, bool cache, const std::string& attention) {
  std::string variant = order;
  if (order == "attention" && attention != "0.5") variant += attention;
  if (!cache) variant += "-nocache";
  return {
      "corrective",
      variant,
      {{"method", "corrective"}, {"order", order}, {"cache", cache ? "on" : "off"}, {"attention", attention}},
      nullptr,
      nullptr};
}

}  // namespace

std::vector<Method> allMethods() {
  std::vector<Method> methods;
  methods.push_back({"base", "", {{"method", "base"}}, nullptr, nullptr});
  for (const bool cache : {true, false}) {
    for (const char* attention : {"0", "0.5", "1"})
      methods.push_back(corrective("attention", cache, attention));
    for (const char* order : {"task", "random", "scanline", "largest"})
      methods.push_back(corrective(order, cache, "0.5"));
  }
  methods.push_back({"raytrace", "", {{"method", "raytrace"}}, nullptr, nullptr});
  methods.push_back({"path", "", {{"method", "path"}}, nullptr, nullptr});
  return methods;
}

}  // namespace saccade::bench
