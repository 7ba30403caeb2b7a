// One call of `saccade bench`, from the first experiment to the page.
#pragma once

#include <stop_token>
#include <string>

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// Runs the chosen experiments, writing records.json and records.csv after each, then plots and page. What
/// the folder already holds of the same commit (and no changed tree) is kept. An experiment that fails is
/// said and the others go on. Returns the exit status: 0, or 1 where an experiment failed or the baseline was
/// missed. Throws core::Error when stopped; what was finished by then is on disk.
int runBench(const BenchOptions& options, const std::string& command, const std::stop_token& stop);

/// The records of a folder that a run of `now` may keep: those of finished experiments measured at the same
/// commit with an unchanged tree by the same command. Pure.
RecordBook keptRecords(const RecordBook& before, const RunInfo& now);

}  // namespace saccade::bench
