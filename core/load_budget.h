// What reading one untrusted file may cost. Charged before memory is allocated, so that a file that lies
// about its sizes ends in an error and not in swapping.
#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>

namespace saccade::core {

/// Half of the machine's memory, but no more than 8192 MiB.
std::uint64_t defaultMaxMemory();

struct LoadLimits {
  std::uint64_t memoryBytes = defaultMaxMemory();  ///< --max-memory
  double seconds = 300;                            ///< --max-load-seconds
  std::stop_token stop;                            ///< who asked for the file wants it no more
};

/// The clock runs from construction. One thread at a time.
class LoadBudget {
 public:
  /// `file` starts the messages.
  LoadBudget(const LoadLimits& limits, std::string file);

  /// Books `bytes` for `what`, an element of the file (its name may come first) or "". Throws core::Error
  /// when they are not left, when the time is up or a stop was requested.
  void charge(std::uint64_t bytes, const std::string& what);
  /// `count` things of `bytesEach`; the product may not fit 64 bits.
  void charge(std::uint64_t count, std::uint64_t bytesEach, const std::string& what);
  /// Gives back what was charged.
  void release(std::uint64_t bytes);

  bool timeIsUp() const;
  /// Throws core::Error when the time is up or a stop was requested. Cheap enough for every thousandth
  /// element.
  void checkTime() const;

  std::uint64_t used() const { return used_; }

 private:
  LoadLimits limits_;
  std::string file_;
  std::uint64_t used_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace saccade::core
