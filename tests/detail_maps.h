// Illumination maps with random texels and blocks of every side, for those who look them up.
#pragma once

#include <algorithm>
#include <random>

#include "core/maps.h"
#include "core/math/half.h"

namespace saccade::tests {

/// Texels in [1, 2). About half of the atlas's texels have a block; columns and rows of blocks are at most
/// 2^`mostLog2`, and width at least 2^mostLog2 + 2.
inline core::IlluminationMaps detailMaps(int width, int height, int layers, int mostLog2, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  core::IlluminationMaps maps;
  maps.width = width;
  maps.height = height;
  maps.layers = layers;
  maps.detail.blocks.assign(static_cast<std::size_t>(width) * height, 0);
  int x = 0, y = 0, shelf = 0;  // where the next block's border begins; blocks lie on shelves
  for (std::uint32_t& packed : maps.detail.blocks) {
    core::MapBlock block{0, 0, below(mostLog2 + 1), below(mostLog2 + 1)};
    if (below(2) == 0 || block.log2Columns + block.log2Rows == 0) continue;
    if (x + block.columns() + 2 > width) {
      y += shelf;
      x = shelf = 0;
    }
    block.x = x + 1;
    block.y = y + 1;
    packed = block.packed();
    x += block.columns() + 2;
    shelf = std::max(shelf, block.rows() + 2);
  }
  maps.detail.height = y + shelf;
  const auto fill = [&](std::vector<std::uint16_t>& texels, int rows) {
    for (std::size_t i = 0; i < std::size_t{3} * width * rows * layers; ++i)
      texels.push_back(core::toHalf(1 + static_cast<float>(below(1024)) / 1024));
  };
  fill(maps.texels, height);
  fill(maps.detail.texels, maps.detail.height);
  return maps;
}

}  // namespace saccade::tests
