#include "bench/harness/child.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/cli/console.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr const char* kCommand = "bench-child";
constexpr int kPollMs = 100;

/// A started process and what it prints. Ends and collects it if nobody has.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw core::Error("no pipe for a child process");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    const int failed = posix_spawn(&pid_, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_ = ends[0];
    if (failed != 0) {
      close(output_);
      throw core::Error("a child process cannot be started");
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

Figures runJob(const std::string& name, const Arguments& arguments) {
  const std::vector<ChildJob>& jobs = allChildJobs();
  const auto job = std::find_if(jobs.begin(), jobs.end(), [&](const ChildJob& j) { return j.name == name; });
  if (job == jobs.end()) throw core::UsageError(name + ": no such measurement");
  return job->run(arguments, app::interruptToken());
}

}  // namespace

std::string toJson(const Figures& figures) { return nlohmann::json(figures).dump(); }

Figures parseFigures(const std::string& json) {
  try {
    return nlohmann::json::parse(json).get<Figures>();
  } catch (const std::exception& e) {
    throw core::Error("not a line of figures: \"" + json.substr(0, 80) + "\"");
  }
}

Figures inChild(const std::string& job, const Arguments& arguments, const std::stop_token& stop) {
  std::vector<std::string> command = {"saccade", kCommand, job};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Process process(command);
  const std::optional<std::string> output = process.read(stop);
  if (!output) throw core::Error("stopped on request");
  const int status = process.wait();
  if (WIFSIGNALED(status)) {
    throw core::Error("the process that measured " + job + " was ended by signal " +
                      std::to_string(WTERMSIG(status)) +
                      (WTERMSIG(status) == SIGKILL ? " (out of memory?)" : ""));
  }
  if (WEXITSTATUS(status) != 0) throw core::Error("the process that measured " + job + " failed");
  return parseFigures(*output);
}

void addChildCommand(CLI::App& program, app::Run& run) {
  CLI::App* command = program.add_subcommand(kCommand, "One measurement of `bench`, in a process of its own");
  command->group("");  // not in the help: `bench` calls it
  auto job = std::make_shared<std::string>();
  auto arguments = std::make_shared<Arguments>();
  command->add_option("JOB", *job, "What to measure")->required();
  command->add_option("ARGUMENTS", *arguments, "As the measurement needs them");
  command->callback([job, arguments, &run] {
    run = [job, arguments] {
      std::printf("%s\n", toJson(runJob(*job, *arguments)).c_str());
      return 0;
    };
  });
}

}  // namespace saccade::bench
