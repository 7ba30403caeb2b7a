// Structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004.
#pragma once

#include "core/image.h"

namespace saccade::core {

/// Mean SSIM of the luma (Rec. 709 weights of the sRGB values, in [0, 1]): Gaussian window of 11 x 11 pixels,
/// sigma 1.5, K1 = 0.01, K2 = 0.03, over the pixels whose window lies inside the image, as in the paper.
/// Departure: an image smaller than the window replicates its border and counts every pixel. Equal sizes, not
/// empty. 1 exactly for identical images. Any thread.
double ssim(const ImageRgba8& reference, const ImageRgba8& test);

}  // namespace saccade::core
