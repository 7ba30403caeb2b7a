// Haber et al. 2001, Figure 5: splats of the first lattice levels.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// A picture and a record for levels 1, 1 + 2, 1-3 and 1-6, "figures/splats-N": `bare` pixels that no splat
/// of ours touches, those of the paper's formula, and samples in the picture.
void drawFigure5(Session& session);

/// A window of `size` x `size` pixels of an endless surface splatted with levels 1..last by the correction
/// layer itself: colours by level, exact pixels (the samples) white, `zoom` times as large. Black = bare.
struct SplatPicture {
  core::ImageRgba8 image;
  int bare = 0;
  int samples = 0;
};
SplatPicture drawSplats(int size, int last, int zoom);

}  // namespace saccade::bench
