// Progress and cancellation of long work, reported from whichever thread does the work.
#pragma once

#include <functional>
#include <stop_token>

#include "core/error.h"

namespace saccade::core {

struct Progress {
  /// Called with the fraction done in [0, 1]; at most some tens of times a second; may be empty.
  std::function<void(double fraction)> report;
  /// Work polls this and returns early (or throws core::Error) when a stop was requested.
  std::stop_token stop;

  /// The same for a part of the work, whose own fraction runs from 0 to 1 while the whole's runs from `from`
  /// to `to`. The whole must outlive it.
  Progress part(double from, double to) const {
    if (!report) return {{}, stop};
    return {[this, from, to](double fraction) { report(from + (to - from) * fraction); }, stop};
  }
};

/// Throws Error where a stop was requested.
inline void throwIfStopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Error("stopped on request");
}

}  // namespace saccade::core
