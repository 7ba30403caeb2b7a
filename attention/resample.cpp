#include "attention/resample.h"

#include <algorithm>
#include <cmath>

namespace saccade::attention {

Resampler::Resampler(const LevelGeometry& from, const LevelGeometry& to)
    : x_(makeAxis(from.width, from.scale, from.offsetX, to.width, to.scale, to.offsetX)),
      y_(makeAxis(from.height, from.scale, from.offsetY, to.height, to.scale, to.offsetY)),
      blended_(static_cast<std::size_t>(from.width) + 1) {}

Resampler::Axis Resampler::makeAxis(int fromCount, float fromScale, float fromOffset, int toCount,
                                    float toScale, float toOffset) {
  Axis axis;
  axis.index.reserve(toCount);
  axis.weight.reserve(toCount);
  for (int i = 0; i < toCount; ++i) {
    const float position = std::clamp((toScale * i + toOffset - fromOffset) / fromScale, 0.0f,
                                      static_cast<float>(fromCount - 1));
    axis.index.push_back(static_cast<int>(position));
    axis.weight.push_back(position - std::floor(position));
  }
  return axis;
}

void Resampler::row(const core::ImageGray& in, int y, float* out) {
  const int above = y_.index[y];
  const int below = std::min(above + 1, in.height() - 1);
  const float* a = &in.at(0, above);
  const float* b = &in.at(0, below);
  const float down = y_.weight[y];
  // a + w (b - a), not (1 - w) a + w b: exact where a = b.
  for (int x = 0; x < in.width(); ++x) blended_[x] = a[x] + down * (b[x] - a[x]);
  blended_[in.width()] = blended_[in.width() - 1];
  const float* blended = blended_.data();
  const int* index = x_.index.data();
  const float* weight = x_.weight.data();
  const int width = static_cast<int>(x_.index.size());
  for (int x = 0; x < width; ++x) {
    const float left = blended[index[x]];
    out[x] = left + weight[x] * (blended[index[x] + 1] - left);
  }
}

}  // namespace saccade::attention
