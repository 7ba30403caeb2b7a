// The commands of the program. Each adds itself to the command line; what runs returns the exit status.
#pragma once

#include <functional>
#include <vector>

namespace CLI {
class App;
}

namespace saccade::app {

/// Each registers one subcommand whose callback stores its work in `run`.
using Run = std::function<int()>;
void addInfoCommand(CLI::App& program, Run& run);
void addBakeCommand(CLI::App& program, Run& run);
void addRenderCommand(CLI::App& program, Run& run);
void addWalkCommand(CLI::App& program, Run& run);
void addCompareCommand(CLI::App& program, Run& run);
void addReplayCommand(CLI::App& program, Run& run);
void addAttentionCommand(CLI::App& program, Run& run);

/// Parses and runs; `further` are commands of rooms above this one. Prints errors as the command line
/// promises. Returns the exit status: 0, 1 failed, 2 wrong usage.
using AddCommand = void (*)(CLI::App& program, Run& run);
int runProgram(int argc, const char* const* argv, const std::vector<AddCommand>& further);

}  // namespace saccade::app
