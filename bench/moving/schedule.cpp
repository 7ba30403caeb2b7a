#include "bench/moving/schedule.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"

namespace saccade::bench {

Stretch Stretch::within(double length, double segment, int segments) {
  assert(segment > 0 && segments > 0);
  if (!(length > 0))
    throw core::Error(
        "the camera path stands still; --path needs at least two keys, the last one later than 0");
  Stretch stretch;
  stretch.segment = std::min(segment, length);
  stretch.segments = std::min(segments, static_cast<int>(length / stretch.segment));
  stretch.begin = (length - stretch.segments * stretch.segment) / 2;
  return stretch;
}

Schedule::Schedule(const Stretch& stretch, double budgetSeconds)
    : stretch_(stretch),
      budget_(budgetSeconds),
      steps_(std::max(1, static_cast<int>(std::lround(stretch.segment / budgetSeconds)))) {
  assert(stretch.segment > 0 && stretch.segments > 0 && budgetSeconds > 0);
}

double Schedule::seconds(int frame) const {
  assert(frame >= 0 && frame < frames());
  const int segment = frame / steps_, step = frame % steps_;
  return stretch_.begin + stretch_.segment * segment + stretch_.segment * step / steps_;
}

}  // namespace saccade::bench
