// saccade bench: any method on any scene and camera path, error against seconds.
#pragma once

#include "app/commands.h"

namespace saccade::bench {

void addBenchCommand(CLI::App& program, app::Run& run);

}  // namespace saccade::bench
