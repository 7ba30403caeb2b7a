// Other programs, run to their end.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

namespace saccade::bench {

/// Runs a program (looked up in PATH) and returns what it printed to stdout; stderr is ours. It inherits the
/// calling thread's cores. Throws core::Error naming `what` when it cannot be started, fails or is killed,
/// and once a stop is requested (the process is ended then). Any thread.
std::string outputOf(const std::string& what, std::vector<std::string> command, const std::stop_token& stop);

}  // namespace saccade::bench
