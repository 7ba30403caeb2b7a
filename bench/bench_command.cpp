#include "bench/bench_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

#include "app/cli/console.h"
#include "bench/harness/method.h"
#include "bench/harness/runner.h"

namespace saccade::bench {
namespace {

std::string experimentList() {
  std::string text = "Experiments:\n";
  for (const Experiment& e : allExperiments()) {
    std::string name = "  " + e.name;
    name.resize(std::max<std::size_t>(name.size() + 1, 18), ' ');
    text += name + e.question + "\n";
  }
  return text;
}

std::vector<std::string> methodNames() {
  std::vector<std::string> names;
  for (const Method& method : allMethods()) {
    if (std::find(names.begin(), names.end(), method.name) == names.end()) names.push_back(method.name);
  }
  return names;
}

/// As the user would type it again.
std::string commandOf(const BenchOptions& o, const std::string& suite) {
  std::string command = "saccade bench " + suite + " -o " + o.folder.string();
  const auto append = [&](const char* option, const std::string& value) {
    if (!value.empty()) command += std::string(" ") + option + " " + value;
  };
  for (const std::string& name : o.only) append("--experiment", name);
  for (const std::string& name : o.scenes) append("--scene", name);
  for (const std::string& name : o.methods) append("--method", name);
  append("--path", o.path);
  if (o.seed != BenchOptions{}.seed) append("--seed", std::to_string(o.seed));
  return command;
}

}  // namespace

void addBenchCommand(CLI::App& program, app::Run& run) {
  CLI::App* command = program.add_subcommand(
      "bench", "Measure: error against seconds of any method, as records, plots and one page");
  auto o = std::make_shared<BenchOptions>();
  auto suite = std::make_shared<std::string>();
  command
      ->add_option(
          "SUITE", *suite,
          "quick: about a minute; paper: the papers' tables and figures; hard: achieved error of the "
          "numerical hard cases; full: everything")
      ->required()
      ->check(CLI::IsMember({"quick", "paper", "hard", "full"}));
  command
      ->add_option(
          "-o,--output", o->folder,
          "Folder for records.json, records.csv, pictures, plots and index.html. Experiments that it "
          "holds already, of the same commit, are kept: a stopped run goes on")
      ->required();
  command->add_option("--experiment", o->only, "Only this experiment (repeatable; see below)");
  command->add_option("--scene", o->scenes, "Scene file instead of the bundled ones (repeatable)")
      ->check(CLI::ExistingFile);
  const std::vector<std::string> methods = methodNames();
  command->add_option("--method", o->methods, "Only this method (repeatable)")->check(CLI::IsMember(methods));
  command
      ->add_option("--path", o->path,
                   "Camera path for --scene (JSON, as for walk); without it a scene's moving camera orbits")
      ->check(CLI::ExistingFile);
  command
      ->add_option(
          "--baseline", o->baseline,
          "records.json of an earlier run: says which ratios moved by more than their noise and which "
          "counts changed; exit status 1 if anything got worse")
      ->check(CLI::ExistingFile);
  command->add_option("--seed", o->seed, "Seed of everything random")->capture_default_str();
  command->footer(experimentList());
  command->callback([o, suite, &run] {
    const std::map<std::string, Suite> suites = {
        {"quick", Suite::quick}, {"paper", Suite::paper}, {"hard", Suite::hard}, {"full", Suite::full}};
    o->suite = suites.at(*suite);
    run = [o, suite] { return runBench(*o, commandOf(*o, *suite), app::interruptToken()); };
  });
}

}  // namespace saccade::bench
