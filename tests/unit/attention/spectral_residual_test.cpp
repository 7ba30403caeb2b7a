#include "attention/spectral_residual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

using core::ImageGray;
using core::ImageRgba8;
using tests::Disc;
using tests::paint;
using tests::rgb;

TEST(SpectralResidual, ConstantImagesGiveExactlyZero) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{0, 0}, {1, 1}, {7, 3}, {64, 64}, {65, 63}, {333, 257}}) {
    for (const core::Rgba8& colour : {rgb(0, 0, 0), rgb(255, 255, 255), rgb(37, 211, 89)}) {
      const ImageGray map = spectralResidual(ImageRgba8(width, height, colour));
      EXPECT_EQ(map.width(), width);
      EXPECT_EQ(map.height(), height);
      EXPECT_TRUE(std::all_of(map.pixels().begin(), map.pixels().end(), [](float v) { return v == 0; }));
    }
  }
}

TEST(SpectralResidual, FindsWhatPopsOut) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{48, 40}, {64, 64}, {100, 75}, {256, 256}, {640, 480}, {1000, 300}}) {
    for (const auto& [fx, fy] : {std::pair{0.5, 0.5}, {0.3, 0.6}, {0.82, 0.21}, {0.15, 0.85}}) {
      ImageRgba8 image(width, height, rgb(90, 90, 90));
      const double workingPixel = std::max(1.0, std::max(width, height) / 64.0);
      const Disc disc{fx * width, fy * height, std::max(0.04 * std::min(width, height), workingPixel)};
      paint(image, disc, rgb(200, 190, 180));
      const tests::Place at = tests::brightestPlace(spectralResidual(image));
      EXPECT_LE(std::hypot(at.x + 0.5 - disc.x, at.y + 0.5 - disc.y), disc.radius + workingPixel)
          << width << " x " << height << ", disc at " << disc.x << ", " << disc.y << ", most salient " << at.x
          << ", " << at.y;
    }
  }
}

TEST(SpectralResidual, LiesBetweenZeroAndOneAtTheImagesSize) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {1, 2}, {2, 1}, {3, 5}, {16, 1000}, {1000, 16}, {64, 48}, {333, 257}, {800, 600}}) {
    const ImageGray map = spectralResidual(tests::randomDiscs(width, height, 10, 11));
    ASSERT_EQ(map.width(), width);
    ASSERT_EQ(map.height(), height);
    const auto [least, most] = std::minmax_element(map.pixels().begin(), map.pixels().end());
    EXPECT_GE(*least, 0);
    EXPECT_LE(*most, 1);
    if (width >= 64 && height >= 48) {
      EXPECT_GT(*most, 0.9f) << width << " x " << height;
    }
  }
}

// The transform knows no left or right: only rounding may differ.
TEST(SpectralResidual, FollowsAMirror) {
  const auto mirrored = [](const auto& in) {
    auto out = in;
    for (int y = 0; y < in.height(); ++y) {
      for (int x = 0; x < in.width(); ++x) out.at(in.width() - 1 - x, y) = in.at(x, y);
    }
    return out;
  };
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{64, 64}, {57, 40}, {256, 192}}) {
    const ImageRgba8 image = tests::randomDiscs(width, height, 12, 77);
    const ImageGray straight = mirrored(spectralResidual(image)), turned = spectralResidual(mirrored(image));
    for (std::size_t i = 0; i < turned.pixels().size(); ++i)
      ASSERT_NEAR(turned.pixels()[i], straight.pixels()[i], 2e-3) << width << " x " << height;
  }
}

}  // namespace
}  // namespace saccade::attention
