#include "bench/quality/quality.h"

#include <gtest/gtest.h>

namespace saccade::bench {
namespace {

TEST(BoxFilter, EveryPixelIsTheMeanOfItsSquare) {
  core::ImageRgb large(8, 12);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 8; ++x) large.at(x, y) = core::Vec3(x, y, x * y);
  }
  const core::ImageRgb small = boxFiltered(large, 4);
  ASSERT_EQ(small.width(), 2);
  ASSERT_EQ(small.height(), 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 2; ++x) {
      const float mx = 4.0f * static_cast<float>(x) + 1.5f, my = 4.0f * static_cast<float>(y) + 1.5f;
      EXPECT_FLOAT_EQ(small.at(x, y).x, mx);
      EXPECT_FLOAT_EQ(small.at(x, y).y, my);
      EXPECT_FLOAT_EQ(small.at(x, y).z, mx * my);  // the mean of a product of independent coordinates
    }
  }
}

TEST(BoxFilter, AFactorOfOneChangesNothing) {
  core::ImageRgb image(3, 2);
  image.at(2, 1) = core::Vec3(0.1f, 0.2f, 0.3f);
  EXPECT_EQ(boxFiltered(image, 1).at(2, 1), image.at(2, 1));
}

}  // namespace
}  // namespace saccade::bench
