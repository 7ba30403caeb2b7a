// Finer texels of illumination maps where light steps.
//
// A texel of the atlas may have a block: side x side cells with a border of one around them, so that bilinear
// look-ups need nothing beside it. A look-up at uv takes the texel t = floor(uv * size), clamped to the
// atlas; without a block it is bilinear between the atlas's texels as ever; with one it is bilinear between
// the block's cells at corner + fract(uv * size) * side, cells' centres at + 0.5.
#pragma once

#include <cstdint>
#include <vector>

namespace saccade::core {

/// Where a block lies in MapDetail: its cells are [x, x + side) x [y, y + side), its border one around them.
struct MapBlock {
  int x = 0, y = 0;  ///< [0, 2^14)
  int log2Side = 0;  ///< [1, 7]

  bool operator==(const MapBlock&) const = default;
  std::uint32_t packed() const {
    return static_cast<std::uint32_t>(log2Side) << 28 | static_cast<std::uint32_t>(y) << 14 |
           static_cast<std::uint32_t>(x);
  }
  static MapBlock unpack(std::uint32_t packed) {
    constexpr std::uint32_t kCoordinate = (1u << 14) - 1;
    return {static_cast<int>(packed & kCoordinate), static_cast<int>(packed >> 14 & kCoordinate),
            static_cast<int>(packed >> 28)};
  }
};

struct MapDetail {
  int height = 0;  ///< rows of `texels`, as wide as the atlas; 0: no detail
  std::vector<std::uint32_t>
      blocks;  ///< per texel of the atlas: MapBlock::packed, 0 = none; empty: no detail
  std::vector<std::uint16_t> texels;  ///< half RGB, all layers: ((layer * height + y) * width + x) * 3
};

}  // namespace saccade::core
