#include "bench/maps/soonness.h"

#include <algorithm>
#include <optional>

namespace saccade::bench {

Record soonness(const std::vector<CurvePoint>& ours, const std::vector<CurvePoint>& gather, double error) {
  Record record;
  record.at = {{"relerr", error}};
  const std::optional<Reached> we = secondsToError(ours, error), they = secondsToError(gather, error);
  if (!we) {
    record.labels["status"] = "not reached";
    return record;
  }
  const auto longest =
      std::max_element(gather.begin(), gather.end(),
                       [](const CurvePoint& a, const CurvePoint& b) { return a.seconds < b.seconds; });
  const double theirs = they ? they->seconds : longest->seconds;
  record.values = {{"seconds_ours", Value::seconds({we->seconds})},
                   {"seconds_gather", Value::seconds({theirs})},
                   {"time_over_gather", Value::ratio({we->seconds / theirs}, Better::lower)}};
  if (!they) {
    record.labels["status"] = "at most: the gather was stopped before it got there";
  } else if (they->atMost) {
    record.labels["status"] = "the gather's first path is good enough";
  } else if (we->atMost) {
    record.labels["status"] = "at most: our cheapest maps are better";
  }
  return record;
}

}  // namespace saccade::bench
