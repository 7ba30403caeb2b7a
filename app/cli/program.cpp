#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "app/cli/console.h"
#include "app/commands.h"
#include "core/error.h"

namespace saccade::app {

namespace {

int usageError(const std::string& text, const std::string& hint) {
  spdlog::error("{}", text);
  spdlog::info("{}", hint);
  return 2;
}

}  // namespace

int runProgram(int argc, const char* const* argv, const std::vector<AddCommand>& further) {
  setupLog();
  CLI::App program("Saccade: walk through scenes with global illumination, ray-traced where you look",
                   "saccade");
  program.require_subcommand(1);
  program.set_version_flag("--version", "saccade 0.1");
  Run run;
  addInfoCommand(program, run);
  addBakeCommand(program, run);
  addRenderCommand(program, run);
  addWalkCommand(program, run);
  addReplayCommand(program, run);
  addCompareCommand(program, run);
  addAttentionCommand(program, run);
  for (const AddCommand add : further) add(program, run);
  try {
    program.parse(argc, argv);
    return run();
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return program.exit(e);
    const auto used = program.get_subcommands();
    const std::string name = used.empty() ? "saccade" : "saccade " + used.front()->get_name();
    return usageError(e.what(), "run '" + name + " --help' for what it takes");
  } catch (const core::UsageError& e) {
    return usageError(e.what(), "run 'saccade --help' for the commands");
  } catch (const std::exception& e) {
    spdlog::error("{}", e.what());
    return 1;
  }
}

}  // namespace saccade::app
