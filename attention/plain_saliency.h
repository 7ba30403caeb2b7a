// The maps of attention/saliency.h as one writes them with OpenCV: what the model's speed is measured
// against. Nothing that saccade shows comes from here.
//
// It differs where OpenCV does: pyrDown keeps every other pixel, so that a level lies half a pixel towards
// the corner of the one before, and every pixel of a plateau is a peak.
#pragma once

#include "core/image.h"

namespace saccade::attention {

/// Saliency per pixel of `displayed` by the normalisation `max`, without orientation; in [0, 1], 1 at the
/// most salient place, 0 where nothing stands out. Sides of at least 256, so that there are nine levels, else
/// core::Error. One thread; any.
core::ImageGray plainSaliency(const core::ImageRgba8& displayed);

}  // namespace saccade::attention
