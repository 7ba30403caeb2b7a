// The panel's plot of error against seconds while the camera rests.
#pragma once

#include "app/session/live_error.h"

namespace saccade::app {

/// Between ImGui's Begin and End: numbers in the colours of their curves, the plot on logarithmic axes with a
/// row of its own for exactly 0, and a line that says what goes on. As wide as the window leaves room.
void drawErrorPlot(const LiveError::State& state, bool corrections);

/// What goes on, in a few words. `corrections` = the window shows them.
std::string errorPlotStatus(const LiveError::State& state, bool corrections);

}  // namespace saccade::app
