// What the user reads on stderr: warnings, errors, progress with time left.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "core/error.h"
#include "core/progress.h"

namespace saccade::app {

/// `saccade: <level>: <text>` lines on stderr. Call once, before anything is logged.
void setupLog();
void printWarnings(const core::Warnings& warnings);

/// A bar with percentage and time left on a terminal; a line per tenth elsewhere. Any thread may call show.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Fraction in [0, 1] of the time since the bar was made.
  void show(double fraction);
  /// For work that knows its own time left, and `stage`, what it is doing.
  void show(double fraction, double secondsLeft, const std::string& stage);

 private:
  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  std::string label_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
  bool terminal_;
  int lastTenth_ = -1;
  bool shown_ = false;
};

/// Stop token raised by SIGINT and SIGTERM once installed: long work ends early, saying so.
std::stop_token interruptToken();

}  // namespace saccade::app
