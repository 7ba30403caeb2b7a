#include "bench/peers/contender.h"

#include <algorithm>
#include <utility>

#include "bench/harness/trials.h"

namespace saccade::bench {

void Trial::add(const Shot& shot, const Truth& truth) {
  seconds.push_back(shot.seconds);
  errors.push_back(errorWithoutNoise(core::compareLinear(truth.picture, shot.linear), truth.noise));
  last = shot.linear;
  spent += shot.seconds;
}

double errorWithoutNoise(const core::Comparison& measured, double noise) {
  return std::max(measured.relmse - noise, 0.1 * noise);
}

std::optional<SecondsTo> secondsTo(const std::vector<Trial>& trials, double error,
                                   const std::vector<double>& further) {
  const Spread extra = further.empty() ? Spread{} : spread(further);
  const auto along = [&](double Spread::*which) {
    std::vector<CurvePoint> curve;
    for (const Trial& t : trials) curve.push_back({spread(t.seconds).*which, spread(t.errors).median});
    std::optional<Reached> reached = secondsToError(curve, error);
    if (reached) reached->seconds += extra.*which;
    return reached;
  };
  const auto median = along(&Spread::median), least = along(&Spread::min), most = along(&Spread::max);
  if (!median || !least || !most) return std::nullopt;
  SecondsTo result{Value::seconds({median->seconds}), median->atMost};
  result.seconds.min = std::min(least->seconds, median->seconds);
  result.seconds.max = std::max(most->seconds, median->seconds);
  const auto fewest = std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.seconds.size() < b.seconds.size();
  });
  result.seconds.repeats = static_cast<int>(fewest->seconds.size());
  return result;
}

Value quotient(const Value& a, const Value& b) {
  Value value = Value::ratio({a.median / b.median}, Better::higher);
  value.min = a.min / b.max;
  value.max = a.max / b.min;
  value.repeats = std::min(a.repeats, b.repeats);
  return value;
}

}  // namespace saccade::bench
