#include "attention/separable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>

namespace saccade::attention {
namespace {

using core::ImageGray;

ImageGray numbered(int width, int height) {
  ImageGray image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<float>((7 * x + 13 * y + x * y) % 17);
  }
  return image;
}

// ... 1 0 | 0 1 .. n-1 | n-1 n-2 ...: one step at a time.
int reflected(int i, int count) {
  while (i < 0 || i >= count) i = i < 0 ? -1 - i : 2 * count - 1 - i;
  return i;
}

// Integers below 2^24 are exact in any order of adding.
TEST(Separable, IsTheSumOverTapsWithMirroredBorders) {
  const std::vector<float> taps{1, -2, 5, 3, 0, 4, 2};
  constexpr int kRadius = 3;
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 5}, {3, 4}, {31, 17}, {64, 8}}) {
    const ImageGray in = numbered(width, height);
    ImageGray alongX(width, height), alongY(width, height);
    std::vector<float> padded;
    filterAlongX(in, taps, alongX, padded);
    filterAlongY(in, taps, alongY);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        float sumX = 0, sumY = 0;
        for (int i = -kRadius; i <= kRadius; ++i) {
          sumX += taps[i + kRadius] * in.at(reflected(x + i, width), y);
          sumY += taps[i + kRadius] * in.at(x, reflected(y + i, height));
        }
        ASSERT_EQ(alongX.at(x, y), sumX) << width << " x " << height << " at " << x << ", " << y;
        ASSERT_EQ(alongY.at(x, y), sumY) << width << " x " << height << " at " << x << ", " << y;
      }
    }
  }
}

TEST(Separable, ConstantImagesStayConstantToTheLastBit) {
  const std::vector<float> taps = gaussianTaps(1.7, 4);
  const ImageGray in(37, 11, 0.3f);
  ImageGray out(37, 11);
  std::vector<float> padded;
  filterAlongX(in, taps, out, padded);
  for (const float v : out.pixels()) ASSERT_EQ(v, out.at(0, 0));
  filterAlongY(in, taps, out);
  for (const float v : out.pixels()) ASSERT_EQ(v, out.at(0, 0));
}

TEST(Separable, GaussianTapsSumToOneAndHaveTheirVariance) {
  for (const double sigma : {1.0, 2.5, 8.0}) {
    const int radius = static_cast<int>(std::ceil(5 * sigma));
    const std::vector<float> taps = gaussianTaps(sigma, radius);
    ASSERT_EQ(taps.size(), 2 * static_cast<std::size_t>(radius) + 1);
    double sum = 0, variance = 0;
    for (int i = -radius; i <= radius; ++i) {
      sum += taps[i + radius];
      variance += taps[i + radius] * i * i;
      EXPECT_EQ(taps[radius + i], taps[radius - i]);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_NEAR(variance, sigma * sigma, 0.002 * sigma * sigma) << sigma;
  }
  EXPECT_EQ(gaussianTaps(0.3, 0), std::vector<float>{1});
}

}  // namespace
}  // namespace saccade::attention
