#include "core/map_detail.h"

#include <algorithm>

namespace saccade::core {

bool fits(const MapDetail& detail, int width, int height, int layers) {
  const auto count = [](int a, int b) {
    return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b);
  };
  if (detail.height < 0) return false;
  if (detail.texels.size() != 3 * count(width, detail.height) * static_cast<std::uint64_t>(layers))
    return false;
  if (detail.blocks.empty()) return detail.height == 0;
  if (detail.blocks.size() != count(width, height)) return false;
  return std::all_of(detail.blocks.begin(), detail.blocks.end(), [&](std::uint32_t packed) {
    const MapBlock b = MapBlock::unpack(packed);
    return packed == 0 || (b.x >= 1 && b.y >= 1 && b.log2Columns + b.log2Rows > 0 &&
                           b.x + b.columns() < width && b.y + b.rows() < detail.height);
  });
}

}  // namespace saccade::core
