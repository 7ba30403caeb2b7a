// Bottom-up attention by another model than the one that orders corrections: Hou and Zhang, "Saliency
// Detection: A Spectral Residual Approach", CVPR 2007, section 3. What is left of a picture's log amplitude
// spectrum after its local mean is taken away, with the picture's own phase, is what stands out. It weighs
// errors (saliency-weighted FLIP), so that no method is graded by its own idea of attention.
//
// Choices, where the paper leaves them open or where we depart:
// - The longer side is 64 pixels (the paper: "height or width"), each a mean over the pixels it covers;
// smaller pictures
//   keep their size. Grey is the mean of the sRGB codes, as the authors' program takes them.
// - The mean of the log spectrum is over 3 x 3 frequencies; beyond the borders the spectrum repeats, as a
// discrete
//   spectrum does (the authors' program replicates its edge).
// - One 8-bit code is added to the amplitude before the logarithm, and the spectrum is multiplied by
// exp(-local mean)
//   rather than rebuilt from amplitude and phase: frequencies that the picture lacks stay 0 instead of
//   becoming noise.
// - The Gaussian has a sigma of 2.5 working pixels and sees 0 beyond the borders, as in the authors' program
// (the paper
//   names sigma 8 without the resolution it holds at).
#pragma once

#include "core/image.h"

namespace saccade::attention {

/// Saliency per pixel of `displayed` (8-bit sRGB, alpha ignored), the same size, in [0, 1]: 1 at the most
/// salient place, up to interpolation; exactly 0 everywhere for constant and empty images. Any thread.
core::ImageGray spectralResidual(const core::ImageRgba8& displayed);

}  // namespace saccade::attention
