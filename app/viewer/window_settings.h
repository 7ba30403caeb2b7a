// How the window starts, from the command line and from what it kept (app/viewer/kept_settings.h), and what
// it keeps at its end.
#pragma once

#include "app/cli/walk_options.h"
#include "app/viewer/kept_settings.h"
#include "app/viewer/panel.h"

namespace saccade::app {

/// What was kept goes where the command line does not say otherwise.
WalkOptions withKept(WalkOptions options, const KeptSettings& kept);
/// Of options that withKept returned.
PanelState firstPanel(const WalkOptions& options, const KeptSettings& kept);

/// How a window looks that was left just now.
struct WindowLook {
  ImageSize size;  ///< as KeptSettings::window
  bool fullscreen = false;
  PanelState panel;
};
/// Only what differs between start and end is kept anew: what one command line asked for stays with it, and
/// what was never touched follows the program's defaults.
void keepChanges(KeptSettings& kept, const WindowLook& start, const WindowLook& end);

}  // namespace saccade::app
