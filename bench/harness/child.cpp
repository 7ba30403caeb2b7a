#include "bench/harness/child.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/console.h"
#include "bench/harness/process.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr const char* kCommand = "bench-child";

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
  std::vector<std::string> command = {"/proc/self/exe", kCommand, job};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return parseFigures(outputOf("the process that measured " + job, std::move(command), stop));
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
