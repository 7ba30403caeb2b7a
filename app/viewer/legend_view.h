// An overlay's legend in the panel.
#pragma once

#include "app/session/overlays.h"

namespace saccade::app {

/// Between ImGui's Begin and End: what the colours mean, then a ramp with the numbers of its ends or a swatch
/// for each category, in the picture's own colours. As wide as there is room.
void drawLegend(const AovLegend& legend, const AovScale& scale);

}  // namespace saccade::app
