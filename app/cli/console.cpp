#include "app/cli/console.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <thread>

namespace saccade::app {

void setupLog() {
  auto logger =
      std::make_shared<spdlog::logger>("saccade", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("saccade: %l: %v");
  spdlog::set_default_logger(std::move(logger));
}

void printWarnings(const core::Warnings& warnings) {
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (terminal_ && shown_) std::fputc('\n', stderr);
}

void ProgressBar::show(double fraction) {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  show(fraction, fraction > 0 ? elapsed / fraction * (1 - fraction) : 0, "");
}

void ProgressBar::show(double fraction, double secondsLeft, const std::string& stage) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
  const std::string doing = stage.empty() ? "" : " (" + stage + ")";
  if (!terminal_) {
    if (percent / 10 <= lastTenth_) return;
    lastTenth_ = percent / 10;
    std::fprintf(stderr, "saccade: %s: %d %%, %.0f s left%s\n", label_.c_str(), percent, secondsLeft,
                 doing.c_str());
    return;
  }
  if (fraction < 1 && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  constexpr int kWidth = 30;
  const std::string bar(static_cast<std::size_t>(percent * kWidth / 100), '#');
  std::fprintf(stderr, "\r%s [%-*s] %3d %%, %.0f s left%s\033[K", label_.c_str(), kWidth, bar.c_str(),
               percent, secondsLeft, doing.c_str());
}

namespace {
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);
}  // namespace

std::stop_token interruptToken() {
  // A signal handler may only set a flag; a watcher turns it into a stop request.
  static std::stop_source source;
  static const std::jthread watcher([](const std::stop_token& ending) {
    while (!ending.stop_requested() && !interrupted)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (interrupted) source.request_stop();
  });
  static const bool installed = [] {
    for (const int signal : {SIGINT, SIGTERM}) {
      std::signal(signal, [](int) {
        if (interrupted.exchange(true)) std::_Exit(130);  // a second signal ends at once
      });
    }
    std::signal(SIGXFSZ, SIG_IGN);  // a quota that is used up is an error of the write
    return true;
  }();
  static_cast<void>(installed);
  return source.get_token();
}

}  // namespace saccade::app
