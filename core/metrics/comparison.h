// Differences of two pictures of the same size: the figures that `saccade compare` prints. Any thread.
#pragma once

#include "core/image.h"

namespace saccade::core {

/// Added to the squared reference in the relative error, so that black pixels count but do not rule.
inline constexpr double kRelativeEpsilon = 0.01;

/// Identical images: 0 exactly, PSNR +infinity, SSIM 1.
struct Comparison {
  double rmse = 0;        ///< over pixels and channels
  double relmse = 0;      ///< mean of (test - reference)^2 / (reference^2 + kRelativeEpsilon)
  double psnr = 0;        ///< dB, for a peak of 1
  double maxAbs = 0;      ///< largest difference of a channel
  double ssim = 1;        ///< core/metrics/ssim.h
  double flip = 0;        ///< mean, core/metrics/flip.h
  double flipMedian = 0;  ///< weighted
  double flipP95 = 0;     ///< weighted
  ImageGray flipMap;
};

/// Errors of linear radiance; SSIM and FLIP of what is seen after the display transform (exposure 0). Throws
/// core::Error where the sizes differ, an image is empty, or a value is not finite.
Comparison compareLinear(const ImageRgb& reference, const ImageRgb& test);

/// Comparison::relmse alone. Throws as compareLinear.
double relativeMse(const ImageRgb& reference, const ImageRgb& test);

/// Errors of sRGB values in [0, 1]; alpha is ignored. Throws as compareLinear.
Comparison compareDisplay(const ImageRgba8& reference, const ImageRgba8& test);

}  // namespace saccade::core
