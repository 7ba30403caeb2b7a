// The walkthrough in a window: mouse-look and WASD, the panel at the side, overlays.
#pragma once

#include "app/cli/walk_options.h"
#include "app/viewer/viewer_state.h"

namespace saccade::app {

/// Opens the scene and runs until the window is closed. Main thread only. Returns the exit status. Throws
/// core::Error when there is no display, saying how to walk off screen, and when the scene cannot be opened.
int runViewer(const WalkOptions& options, const ViewerObserver& afterFrame = {});

}  // namespace saccade::app
