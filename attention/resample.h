// Bilinear interpolation from one pyramid level to the sample positions of another.
#pragma once

#include <vector>

#include "attention/pyramid.h"
#include "core/image.h"

namespace saccade::attention {

/// One owner, one thread at a time; allocates on construction only. Positions outside `from` take its border.
class Resampler {
 public:
  Resampler(const LevelGeometry& from, const LevelGeometry& to);

  /// Row y of `to` from an image of `from`'s size; out: `to`'s width. A constant image stays so to the last
  /// bit.
  void row(const core::ImageGray& in, int y, float* out);

 private:
  struct Axis {
    std::vector<int> index;     ///< the sample before the position
    std::vector<float> weight;  ///< of the sample after it
  };
  static Axis makeAxis(int fromCount, float fromScale, float fromOffset, int toCount, float toScale,
                       float toOffset);

  Axis x_, y_;
  std::vector<float> blended_;  ///< a row of `from`, and one more so that the last sample has a next one
};

}  // namespace saccade::attention
