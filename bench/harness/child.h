// A measurement in a process of its own: its peak of memory is nobody else's, and Mesa starts fresh.
#pragma once

#include <functional>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "app/commands.h"

namespace saccade::bench {

using Figures = std::map<std::string, double>;
using Arguments = std::vector<std::string>;

/// What can be run so. Jobs of an experiment are listed in bench/child_jobs.cpp.
struct ChildJob {
  std::string name;
  Figures (*run)(const Arguments& arguments, const std::stop_token& stop);
};
const std::vector<ChildJob>& allChildJobs();

/// Runs a job in a new process of this program, which inherits the calling thread's cores and prints to
/// stderr, and waits for it. Throws core::Error naming the job when it fails, when it was killed (out of
/// memory, say), and once a stop is requested (the process is ended then). Any thread.
Figures inChild(const std::string& job, const Arguments& arguments, const std::stop_token& stop);

/// The other end: `saccade bench-child JOB ARGUMENTS...`, which no help names.
void addChildCommand(CLI::App& program, app::Run& run);

/// Figures as one line of JSON and back. Throws core::Error for anything else.
std::string toJson(const Figures& figures);
Figures parseFigures(const std::string& json);

}  // namespace saccade::bench
