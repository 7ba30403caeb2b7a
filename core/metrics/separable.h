// Separable filters with replicated borders, for the metrics. Any thread.
#pragma once

#include <span>

#include "core/image.h"

namespace saccade::core {

/// Correlates the rows with `alongX` and the columns with `alongY`; both of odd length, centred. Pixels
/// outside the image are those of its border.
ImageGray filterSeparable(const ImageGray& image, std::span<const float> alongX,
                          std::span<const float> alongY);

}  // namespace saccade::core
