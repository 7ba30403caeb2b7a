// The walkthrough in a window: mouse-look and WASD, the panel at the side, overlays.
#pragma once

#include "app/cli/walk_options.h"
#include "app/session/workspace.h"

namespace saccade::app {

/// Runs until the window is closed. Main thread only. Returns the exit status. Throws core::Error when there
/// is no display, saying how to walk off screen.
int runViewer(const WalkOptions& options, const Workspace& workspace);

}  // namespace saccade::app
