// A recorded session in a window.
#pragma once

#include "app/cli/replay_options.h"

namespace saccade::app {

/// Shows the frames at their recorded times, then the last one until the window is closed. Space halts and
/// goes on. Main thread only. Returns the exit status. Throws core::Error when there is no display, or
/// nothing to show.
int runReplayViewer(const ReplayOptions& options);

}  // namespace saccade::app
