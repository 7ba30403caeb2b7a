// Progress and cancellation of long work, reported from whichever thread does the work.
#pragma once

#include <functional>
#include <stop_token>

namespace saccade::core {

struct Progress {
  /// Called with the fraction done in [0, 1]; at most some tens of times a second; may be empty.
  std::function<void(double fraction)> report;
  /// Work polls this and returns early (or throws core::Error) when a stop was requested.
  std::stop_token stop;
};

}  // namespace saccade::core
