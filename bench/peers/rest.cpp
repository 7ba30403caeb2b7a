#include "bench/peers/rest.h"

#include <algorithm>

#include "core/metrics/comparison.h"

namespace saccade::bench {
namespace {

constexpr float kStep = 0.2f;    ///< of the base's sum of channels from pixel to pixel
constexpr float kBlack = 0.01f;  ///< added to it, so that darkness has no edges

float brightness(const core::FrameSnapshot& frame, int x, int y) {
  const core::Vec4& base = frame.baseAndId[frame.index(x, y)];
  return base.x + base.y + base.z + kBlack;
}

}  // namespace

Part partOf(const core::FrameSnapshot& frame, int x, int y) {
  const int right = std::min(x + 1, frame.view.width() - 1), below = std::min(y + 1, frame.view.height() - 1);
  float least = brightness(frame, x, y), most = least;
  for (int j = std::max(y - 1, 0); j <= below; ++j) {
    for (int i = std::max(x - 1, 0); i <= right; ++i) {
      if (frame.idAt(i, j) != frame.idAt(x, y)) return Part::edge;
      least = std::min(least, brightness(frame, i, j));
      most = std::max(most, brightness(frame, i, j));
    }
  }
  if (most > (1 + kStep) * least) return Part::edge;
  return frame.idAt(x, y) != 0 ? Part::corrected : Part::maps;
}

std::array<Share, static_cast<std::size_t>(Part::count)> sharesOfError(const core::ImageRgb& picture,
                                                                       const ReferenceSums& reference,
                                                                       const core::FrameSnapshot& frame) {
  const core::ImageRgb truth = reference.mean(), a = reference.half(0), b = reference.half(1);
  std::array<Share, static_cast<std::size_t>(Part::count)> shares{};
  const double pixels = static_cast<double>(picture.width()) * picture.height();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      Share& share = shares[static_cast<std::size_t>(partOf(frame, x, y))];
      share.area += 1 / pixels;
      for (int c = 0; c < 3; ++c) {
        const double t = truth.at(x, y)[c], error = picture.at(x, y)[c] - t;
        const double noise = (a.at(x, y)[c] - b.at(x, y)[c]) / 2;
        share.relmse += (error * error - noise * noise) / (t * t + core::kRelativeEpsilon) / (3 * pixels);
      }
    }
  }
  return shares;
}

}  // namespace saccade::bench
