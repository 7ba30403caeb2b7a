// The image pyramid of Itti, Koch and Niebur 1998, section "Extraction of early visual features": intensity
// and the double-opponent pairs red-green and blue-yellow on up to nine dyadic levels.
//
// Departures, with their reasons:
// - The broad-tuned R, G, B and Y have no pyramids of their own: only R - G and B - Y are used, and low-pass
//   filtering is linear, so three planes do for five.
// - Level 0 is filtered while it is converted and never stored (unless the image is so small that a centre
// lies
//   there): no centre is finer than level 2.
// - Halving keeps the image's centre in place. The usual filter keeps every other pixel, which moves level l
// by
//   (2^l - 1) / 2 pixels of the image towards a corner and so centre and surround apart, by 60 pixels for the
//   pair (4, 7). Here an even side is halved by the taps 1 3 3 1 between its pixels, an odd one by 1 4 6 4 1
//   on its even pixels; LevelGeometry says where the samples lie.
// - Values are integers before filtering and the taps powers of two over integers, so that a constant image
// is
//   constant on every level to the last bit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"

namespace saccade::attention {

enum Channel { kIntensity, kRedGreen, kBlueYellow, kChannels };

/// Sum r + g + b of 8-bit values.
inline constexpr float kIntensityRange = 3 * 255;
/// R - G and B - Y are stored in units of 1 / kHueUnit; of hue-normalised channels, r + g + b = 3.
inline constexpr float kHueUnit = 1024;
inline constexpr float kHueRange = 3 * kHueUnit;

/// Sample i of a level lies at position scale * i + offset of level 0, in pixels with centres at integers.
struct LevelGeometry {
  int width = 0, height = 0;
  float scale = 1;
  float offsetX = 0, offsetY = 0;
};

/// The levels of an image of this size, 0 first: nine, or fewer where 1 x 1 is reached before.
std::vector<LevelGeometry> pyramidGeometry(int width, int height);

/// `out` (of the next level's size) = `in` filtered and halved. `padded` is scratch, grown as needed.
void halve(const core::ImageGray& in, core::ImageGray& out, std::vector<float>& padded);

/// One owner, one thread at a time. Allocates only when the image's size changes.
class OpponentPyramid {
 public:
  /// Stores the levels from max(firstLevel, 0) on that are wanted; level 1 and up are always there.
  void resize(const std::vector<LevelGeometry>& levels, bool storeLevel0);
  /// `displayed`: of the size of level 0, alpha ignored.
  void build(const core::ImageRgba8& displayed);
  /// Level 0 only where it is stored.
  const core::ImageGray& plane(int level, Channel channel) const { return planes_[level][channel]; }

 private:
  using Planes = std::array<core::ImageGray, kChannels>;
  void buildLevel1(const core::ImageRgba8& displayed, int brightest);
  std::span<const std::uint32_t> packedRow(const core::ImageRgba8& displayed, int y);

  std::vector<Planes> planes_;
  bool storeLevel0_ = false;
  std::vector<std::uint32_t> packed_;  ///< one row of the image
  std::vector<float> ring_;            ///< the rows of level 0 that level 1 needs at a time
  std::vector<float> padded_;          ///< one row with two more pixels at either end
};

}  // namespace saccade::attention
