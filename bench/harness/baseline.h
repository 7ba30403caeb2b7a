// The regression guard: what moved between two measurements, told from figures that another machine or a busy
// one does not move.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/harness/record.h"

namespace saccade::bench {

/// A ratio whose medians lie closer together, relative to the earlier one, has not moved, however narrow its
/// ranges: five repeats of one run say nothing of what differs between runs (addresses, page cache).
inline constexpr double kNoiseFloor = 0.03;

enum class Verdict {
  worse,
  better,
  changed  ///< neither direction is the better one
};

/// A value that moved.
struct Change {
  std::string key, metric;
  Value before, now;
  Verdict verdict = Verdict::changed;
  bool loaded = false;  ///< in either run; judged all the same
};

struct BaselineReport {
  std::vector<Change> changes;  ///< worse ones first, else as in `now`
  /// Keys, "key:metric" where only a value is missing, "every record of EXPERIMENT" where all are.
  std::vector<std::string> onlyBefore, onlyNow;
  std::size_t ratios = 0, counts = 0;  ///< compared
  std::size_t otherSeeds = 0;          ///< counts not compared, as the seeds differ

  std::size_t howMany(Verdict verdict) const;
};

/// A ratio moved when the ranges of its repeats do not overlap and its medians differ by more than
/// kNoiseFloor; a count when it differs at all. A value that stopped being finite is worse. Times, rates,
/// bytes and errors within a time are not judged: they belong to a machine and its load. Pure.
BaselineReport compareToBaseline(const RecordBook& before, const RecordBook& now);

/// One line a change or missing record, and a line that sums up.
std::string toText(const BaselineReport& report);

}  // namespace saccade::bench
