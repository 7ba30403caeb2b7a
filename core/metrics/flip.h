// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator
// for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.
// Any thread.
#pragma once

#include <stop_token>

#include "core/image.h"

namespace saccade::core {

/// A 0.7 m wide display of 3840 pixels seen from 0.7 m, as in the paper.
inline constexpr double kFlipPixelsPerDegree = 67.0206;

/// Error map in [0, 1] of two sRGB images of equal size; exactly 0 where the neighbourhoods are identical.
/// About a quarter of a second at 512 x 512. Throws core::Error when stopped.
ImageGray flip(const ImageRgba8& reference, const ImageRgba8& test,
               double pixelsPerDegree = kFlipPixelsPerDegree, const std::stop_token& stop = {});

/// 0 for an empty map.
double meanOf(const ImageGray& map);

/// Mean of the map's pixels, each counted as often as its weight says: saliency-weighted FLIP with a saliency
/// map as weights. Weights are at least 0; where all are 0 (nothing stands out) it is the plain mean. Throws
/// core::Error where the sizes differ.
double weightedMeanOf(const ImageGray& map, const ImageGray& weights);

/// The value below which `fraction` of the map's total error lies, so that large areas without error do not
/// hide the errors (as in the tool that the paper's authors publish). `fraction` in [0, 1].
double weightedPercentile(const ImageGray& map, double fraction);

}  // namespace saccade::core
