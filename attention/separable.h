// Separable filters for maps and pyramid levels, on memory of the caller's.
#pragma once

#include <span>
#include <vector>

#include "core/image.h"

namespace saccade::attention {

/// `out` (of the size of `in`, another image) = `in` correlated with `taps` (an odd number, centred) along
/// its rows or along its columns. Beyond its borders an image goes on as in a mirror, as often as it takes:
/// zeros there would tell the middle from the border. A constant image stays constant to the last bit.
/// `padded` is scratch, grown as needed. Any thread.
void filterAlongX(const core::ImageGray& in, std::span<const float> taps, core::ImageGray& out,
                  std::vector<float>& padded);
void filterAlongY(const core::ImageGray& in, std::span<const float> taps, core::ImageGray& out);

/// Of sum 1 over 2 radius + 1 taps; sigma > 0 in samples.
std::vector<float> gaussianTaps(double sigma, int radius);

}  // namespace saccade::attention
