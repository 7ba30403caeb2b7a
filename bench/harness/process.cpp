#include "bench/harness/process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <optional>

#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr int kPollMs = 100;
constexpr int kSignalled = 128;  ///< as shells say it

/// A started process and what it prints. Ends and collects it if nobody has.
class Process {
 public:
  Process(const std::string& what, std::vector<std::string> command) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw core::Error(what + ": no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<char*> argv;
    for (std::string& a : command) argv.push_back(a.data());
    argv.push_back(nullptr);
    const int failed = posix_spawnp(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_ = ends[0];
    if (failed != 0) {
      close(output_);
      throw core::Error(what + " cannot be started: " + std::strerror(failed));
    }
  }
  ~Process() {
    close(output_);
    if (!ended_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Everything it prints until it closes its output; nothing once stopped.
  std::optional<std::string> read(const std::stop_token& stop) const {
    std::string text;
    std::array<char, 4096> buffer{};
    while (!stop.stop_requested()) {
      pollfd ready{output_, POLLIN, 0};
      if (poll(&ready, 1, kPollMs) <= 0) continue;
      const ssize_t n = ::read(output_, buffer.data(), buffer.size());
      if (n <= 0) return text;
      text.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return std::nullopt;
  }

  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    ended_ = true;
    return status;
  }

 private:
  pid_t pid_ = 0;
  int output_ = -1;
  bool ended_ = false;
};

}  // namespace

Outcome runToEnd(const std::string& what, std::vector<std::string> command, const std::stop_token& stop) {
  Process process(what, std::move(command));
  std::optional<std::string> output = process.read(stop);
  if (!output) throw core::Error("stopped on request");
  const int status = process.wait();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status), *std::move(output)};
}

std::string outputOf(const std::string& what, std::vector<std::string> command, const std::stop_token& stop) {
  Outcome outcome = runToEnd(what, std::move(command), stop);
  if (outcome.status > kSignalled) {
    const int signal = outcome.status - kSignalled;
    throw core::Error(what + " was ended by signal " + std::to_string(signal) +
                      (signal == SIGKILL ? " (out of memory?)" : ""));
  }
  if (outcome.status != 0) throw core::Error(what + " failed with status " + std::to_string(outcome.status));
  return std::move(outcome.output);
}

}  // namespace saccade::bench
