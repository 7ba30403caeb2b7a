// Other programs, run to their end.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

namespace saccade::bench {

/// How a program ended.
struct Outcome {
  int status = 0;      ///< exit status, or 128 + the signal that ended it
  std::string output;  ///< stdout; stderr is ours
};

/// Runs a program (looked up in PATH) to its end, whatever that is. It inherits the calling thread's cores.
/// Throws core::Error naming `what` when it cannot be started, and once a stop is requested (the process is
/// ended then). Any thread.
Outcome runToEnd(const std::string& what, std::vector<std::string> command, const std::stop_token& stop);

/// What it printed to stdout. Throws core::Error when it failed or was killed, too.
std::string outputOf(const std::string& what, std::vector<std::string> command, const std::stop_token& stop);

}  // namespace saccade::bench
