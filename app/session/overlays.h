// What the frame knows beside its colours: for --aov and for the window's overlays.
#pragma once

#include <string>
#include <vector>

#include "app/session/frame_loop.h"
#include "core/image.h"

namespace saccade::app {

enum class Aov { id, saliency, level, thread, age };

/// Names as on the command line, in the order of the enum.
const std::vector<std::string>& aovNames();
/// Throws core::UsageError listing the names.
Aov aovByName(const std::string& name);

/// Exact values a pixel: id 0.. ; saliency [0, 1]; level 0 (uncorrected) to 7; thread 1.. (0 = none);
/// age in camera changes, 0 = fresh, -1 = no sample.
core::ImageGray aovValues(Aov aov, const FrameLoop& loop);

/// The values in legend colours: categorical for id, level and thread, a ramp for saliency and age; no value
/// = black.
core::ImageRgba8 aovPicture(Aov aov, const core::ImageGray& values, int maxAge);

/// One line that explains the colours.
const char* aovLegend(Aov aov);

}  // namespace saccade::app
