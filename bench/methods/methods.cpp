// The list of methods. A later capability adds its rows here.
#include "attention/importance.h"
#include "bench/harness/method.h"
#include "bench/methods/stills.h"
#include "bench/methods/walkers.h"

namespace saccade::bench {
namespace {

struct NamedOrder {
  attention::Order order;
  const char* name;
};

/// Order, cache and attention of a corrective variant, as its labels and its key say them. On a still view
/// nothing is in the cache, so variants without it have none of their own; the order counts only until the
/// picture has converged.
Method corrective(const NamedOrder& order, bool cache, const char* weight) {
  const std::string name = order.name;
  std::string variant = name;
  const bool usual = name == "attention" && weight == std::string("0.5");
  if (name == "attention" && !usual) variant += weight;
  if (!cache) variant += "-nocache";
  attention::AttentionOptions attention;
  attention.order = order.order;
  attention.attention = std::stof(weight);
  Method method{
      "corrective",
      variant,
      {{"method", "corrective"}, {"order", name}, {"cache", cache ? "on" : "off"}, {"attention", weight}},
      nullptr,
      [=](Stage& stage, app::ImageSize size) { return walkCorrective(stage, size, attention, cache); }};
  if (cache) {
    method.still = [=](Stage& stage, const StillTask& task, const TakePoint& take) {
      stillCorrective(stage, task, take, attention, usual);
    };
    method.afterSamples = [=](Stage& stage, const StillTask& task, std::uint64_t samples) {
      return stillAfterSamples(stage, task, attention, samples);
    };
  }
  return method;
}

}  // namespace

std::vector<Method> allMethods() {
  constexpr NamedOrder kAttention{attention::Order::attention, "attention"};
  constexpr NamedOrder kOthers[] = {{attention::Order::task, "task"},
                                    {attention::Order::random, "random"},
                                    {attention::Order::scanline, "scanline"},
                                    {attention::Order::largest, "largest"}};
  std::vector<Method> methods;
  methods.push_back({"base", "", {{"method", "base"}}, stillBase, walkBase});
  for (const bool cache : {true, false}) {
    for (const char* weight : {"0", "0.5", "1"}) methods.push_back(corrective(kAttention, cache, weight));
    for (const NamedOrder& order : kOthers) methods.push_back(corrective(order, cache, "0.5"));
  }
  methods.push_back({"raytrace", "", {{"method", "raytrace"}}, stillRaytrace, walkRaytrace});
  methods.push_back({"path", "", {{"method", "path"}}, stillPath, walkPath});
  return methods;
}

}  // namespace saccade::bench
