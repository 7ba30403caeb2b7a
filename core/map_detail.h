// Finer texels of illumination maps where light steps.
//
// A texel of the atlas may have a block: columns x rows cells with a border of one around them, so that
// bilinear look-ups need nothing beside it. A look-up at uv takes the texel t = floor(uv * size), clamped to
// the atlas; without a block it is bilinear between the atlas's texels as ever; with one it is bilinear
// between the block's cells at corner + fract(uv * size) * (columns, rows), cells' centres at + 0.5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace saccade::core {

/// Where a block lies in MapDetail: its cells are [x, x + columns) x [y, y + rows), its border one around.
struct MapBlock {
  static constexpr int kMostLog2 = 7;
  static constexpr int kLargestCoordinate = (1 << 13) - 1;

  int x = 0, y = 0;                   ///< [1, kLargestCoordinate]
  int log2Columns = 0, log2Rows = 0;  ///< [0, kMostLog2], not both 0
  int columns() const { return 1 << log2Columns; }
  int rows() const { return 1 << log2Rows; }
  /// Border included.
  std::size_t texels() const {
    return static_cast<std::size_t>(columns() + 2) * static_cast<std::size_t>(rows() + 2);
  }

  bool operator==(const MapBlock&) const = default;
  /// Never 0.
  std::uint32_t packed() const {
    return static_cast<std::uint32_t>(log2Rows) << 29 | static_cast<std::uint32_t>(log2Columns) << 26 |
           static_cast<std::uint32_t>(y) << 13 | static_cast<std::uint32_t>(x);
  }
  static MapBlock unpack(std::uint32_t packed) {
    const auto field = [packed](int from, std::uint32_t most) {
      return static_cast<int>(packed >> from & most);
    };
    return {field(0, kLargestCoordinate), field(13, kLargestCoordinate), field(26, kMostLog2),
            field(29, kMostLog2)};
  }
};

struct MapDetail {
  int height = 0;  ///< rows of `texels`, as wide as the atlas; 0: no detail
  std::vector<std::uint32_t>
      blocks;  ///< per texel of the atlas: MapBlock::packed, 0 = none; empty: no detail
  std::vector<std::uint16_t> texels;  ///< half RGB, all layers: ((layer * height + y) * width + x) * 3

  bool empty() const { return blocks.empty(); }
};

/// Whether look-ups in an atlas of this size stay within `detail`: its counts are right, and every block lies
/// inside with its border. Blocks may share texels.
bool fits(const MapDetail& detail, int width, int height, int layers);

}  // namespace saccade::core
