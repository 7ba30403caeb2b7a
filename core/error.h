// How failures travel (one page, three cases):
//   a logic error of ours        -> assert;
//   a run-time failure           -> throw core::Error, whose text is the line the user reads after
//                                   "saccade: error: ", names the file and element, and says what to do;
//   a repair or fallback         -> core::Warnings, printed as "saccade: warning: ...", counted.
// Likely failures (a queue that is closed, a point behind the camera) are return values.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace saccade::core {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Wrong usage: exit status 2 instead of 1.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Warnings in the order they arose; one thread at a time.
using Warnings = std::vector<std::string>;

}  // namespace saccade::core
