// What is left of an error once a picture has converged, and where it is.
#pragma once

#include <array>

#include "bench/reference/sums.h"
#include "core/corrective/messages.h"
#include "core/image.h"

namespace saccade::bench {

/// Parts of a corrected picture, in the order in which a pixel is asked.
enum class Part {
  edge,  ///< beside another object, or where the base changes by a fifth: one ray a pixel cannot be right
  corrected,  ///< traced
  maps,       ///< shown from the illumination maps
  count
};

/// Of a pixel inside the frame.
Part partOf(const core::FrameSnapshot& frame, int x, int y);

/// By part: its share of the relative MSE of `picture` (the shares' sum is the whole), with the noise of the
/// reference taken out by the difference of its halves, and the share of the pixels that it covers.
struct Share {
  double relmse = 0, area = 0;
};
std::array<Share, static_cast<std::size_t>(Part::count)> sharesOfError(const core::ImageRgb& picture,
                                                                       const ReferenceSums& reference,
                                                                       const core::FrameSnapshot& frame);

}  // namespace saccade::bench
