// The walkthrough in a window: mouse-look and WASD, the panel at the side, overlays.
#pragma once

#include "app/cli/walk_options.h"
#include "app/viewer/viewer_state.h"

namespace saccade::app {

/// Runs until the window is closed; opens the scene meanwhile, or shows how to open one. Main thread only.
/// Returns the exit status: 1 where the scene could not be opened, which the window says, or not be recorded.
/// Throws core::Error when there is no display, saying how to walk off screen.
int runViewer(const WalkOptions& options, const ViewerObserver& afterFrame = {});

}  // namespace saccade::app
