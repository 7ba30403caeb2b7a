// Colours for error maps, heat overlays and categories. Any thread.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace saccade::core {

/// Black through violet, red and orange to pale yellow, lightness rising steadily (after matplotlib's
/// "magma"). Clamped to [0, 1]; NaN gives 0's colour.
Rgba8 rampColor(float value);

/// A map of values as colours, pixel by pixel.
ImageRgba8 rampPicture(const ImageGray& map);

/// A colour for a category; 0 is black. The first few look as different as they can, the first 10,000 differ.
Rgba8 paletteColor(std::uint32_t id);

}  // namespace saccade::core
