// Blocks of finer texels: packed and back, and told apart from those that look-ups would leave.
#include "core/map_detail.h"

#include <gtest/gtest.h>

namespace saccade::core {
namespace {

constexpr int kWidth = 10, kHeight = 3, kLayers = 2, kRows = 8;

MapDetail with(const MapBlock& block) {
  MapDetail detail;
  detail.height = kRows;
  detail.blocks.assign(kWidth * kHeight, 0);
  detail.blocks[7] = block.packed();
  detail.texels.assign(kWidth * kRows * kLayers * 3, 0);
  return detail;
}
bool fitsHere(const MapDetail& detail) { return fits(detail, kWidth, kHeight, kLayers); }

TEST(MapBlock, EveryFieldComesBackFromThePackedForm) {
  for (const int x : {0, 1, 5000, MapBlock::kLargestCoordinate}) {
    for (const int y : {0, 1, 4321, MapBlock::kLargestCoordinate}) {
      for (int columns = 0; columns <= MapBlock::kMostLog2; ++columns) {
        for (int rows = 0; rows <= MapBlock::kMostLog2; ++rows) {
          const MapBlock block{x, y, columns, rows};
          EXPECT_EQ(MapBlock::unpack(block.packed()), block);
        }
      }
    }
  }
}

TEST(MapDetail, NoneFitsEveryAtlas) {
  EXPECT_TRUE(fitsHere({}));
  MapDetail rowsOnly = with({1, 1, 1, 0});
  rowsOnly.blocks.clear();
  EXPECT_FALSE(fitsHere(rowsOnly));
}

TEST(MapDetail, ABlockFitsWithItsBorderOrNotAtAll) {
  for (int columns = 0; columns <= MapBlock::kMostLog2; ++columns) {
    for (int rows = 0; rows <= MapBlock::kMostLog2; ++rows) {
      for (int x = 0; x <= kWidth; ++x) {
        for (int y = 0; y <= kRows; ++y) {
          const bool inside =
              x >= 1 && y >= 1 && x + (1 << columns) + 1 <= kWidth && y + (1 << rows) + 1 <= kRows;
          const bool block = columns + rows > 0;
          const bool none = x == 0 && y == 0 && !block;
          EXPECT_EQ(fitsHere(with({x, y, columns, rows})), none || (block && inside))
              << x << ", " << y << ", " << columns << " x " << rows;
        }
      }
    }
  }
}

TEST(MapDetail, CountsMustBeThoseOfTheAtlas) {
  const MapDetail good = with({1, 1, 2, 1});
  ASSERT_TRUE(fitsHere(good));
  MapDetail bad = good;
  bad.blocks.pop_back();
  EXPECT_FALSE(fitsHere(bad));
  bad = good;
  bad.texels.pop_back();
  EXPECT_FALSE(fitsHere(bad));
  bad = good;
  bad.height = -1;
  EXPECT_FALSE(fitsHere(bad));
  EXPECT_FALSE(fits(good, kWidth, kHeight, 1));
  EXPECT_FALSE(fits(good, kWidth + 1, kHeight, kLayers));
}

}  // namespace
}  // namespace saccade::core
