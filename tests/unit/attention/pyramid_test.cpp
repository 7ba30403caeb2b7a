#include "attention/pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "attention/normalise.h"
#include "attention/resample.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

using core::ImageGray;
using tests::rgb;

TEST(Pyramid, HasNineLevelsOrEndsAtOnePixel) {
  EXPECT_EQ(pyramidGeometry(512, 512).size(), 9u);
  EXPECT_EQ(pyramidGeometry(256, 256).size(), 9u);
  EXPECT_EQ(pyramidGeometry(8192, 16).size(), 9u);
  EXPECT_EQ(pyramidGeometry(16, 16).size(), 5u);
  EXPECT_EQ(pyramidGeometry(17, 33).size(), 7u);
  EXPECT_EQ(pyramidGeometry(1, 1).size(), 1u);
}

// The middle of the samples' positions is the middle of the image on every level.
TEST(Pyramid, LevelsStayCentred) {
  for (const auto& [width, height] : {std::pair{512, 512}, {333, 257}, {800, 600}, {17, 33}, {1, 64}}) {
    for (const LevelGeometry& l : pyramidGeometry(width, height)) {
      EXPECT_EQ(l.offsetX + l.scale * (l.width - 1) / 2, (width - 1) / 2.0f)
          << width << ", level of " << l.width;
      EXPECT_EQ(l.offsetY + l.scale * (l.height - 1) / 2, (height - 1) / 2.0f)
          << height << ", level of " << l.height;
    }
  }
}

// Halving keeps ramps (away from the border), and so does the way back: centre and surround are registered.
TEST(Pyramid, RampsComeBackWhereTheyWere) {
  for (const int side : {256, 257, 300, 333}) {
    const std::vector<LevelGeometry> levels = pyramidGeometry(side, side);
    ImageGray image(side, side);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) image.at(x, y) = static_cast<float>(x - 2 * y);
    }
    std::vector<float> padded;
    ImageGray coarse = image;
    constexpr int kLevel = 3;
    for (int l = 0; l < kLevel; ++l) {
      ImageGray next(levels[l + 1].width, levels[l + 1].height);
      halve(coarse, next, padded);
      coarse = next;
    }
    Resampler back(levels[kLevel], levels[0]);
    std::vector<float> row(side);
    for (int y = 40; y < side - 40; y += 7) {
      back.row(coarse, y, row.data());
      for (int x = 40; x < side - 40; ++x)
        ASSERT_NEAR(row[x], image.at(x, y), 1e-2f) << side << ": " << x << ", " << y;
    }
  }
}

TEST(Pyramid, OpponentChannelsHaveTheirSigns) {
  const auto mean = [](core::Rgba8 colour, Channel channel) {
    OpponentPyramid pyramid;
    pyramid.resize(pyramidGeometry(16, 16), true);
    core::ImageRgba8 image(16, 16, colour);
    pyramid.build(image);
    return pyramid.plane(4, channel).at(0, 0);
  };
  EXPECT_EQ(mean(rgb(255, 0, 0), kRedGreen), 3 * kHueUnit);
  EXPECT_EQ(mean(rgb(0, 255, 0), kRedGreen), -3 * kHueUnit);
  EXPECT_EQ(mean(rgb(0, 0, 255), kBlueYellow), 3 * kHueUnit);
  EXPECT_EQ(mean(rgb(200, 200, 0), kBlueYellow), -1.5f * kHueUnit);
  EXPECT_EQ(mean(rgb(120, 120, 120), kRedGreen), 0);
  EXPECT_EQ(mean(rgb(120, 120, 120), kBlueYellow), 0);
  EXPECT_EQ(mean(rgb(1, 2, 3), kIntensity), 6);
}

// Streaming level 0 and storing it are two ways to the same numbers.
TEST(Pyramid, StoredAndStreamedLevelZeroAgree) {
  for (const auto& [width, height] : {std::pair{64, 64}, {65, 31}, {2, 3}}) {
    const core::ImageRgba8 image = tests::randomDiscs(width, height, 6, 9);
    OpponentPyramid stored, streamed;
    stored.resize(pyramidGeometry(width, height), true);
    streamed.resize(pyramidGeometry(width, height), false);
    stored.build(image);
    streamed.build(image);
    for (const Channel c : {kIntensity, kRedGreen, kBlueYellow}) {
      EXPECT_EQ(stored.plane(1, c).pixels(), streamed.plane(1, c).pixels());
    }
  }
}

// Very dark pixels have no hue: theirs is noise.
TEST(Pyramid, HueNeedsATenthOfTheBrightest) {
  core::ImageRgba8 image(16, 16, rgb(20, 0, 0));
  image.at(0, 0) = rgb(255, 255, 255);
  OpponentPyramid pyramid;
  pyramid.resize(pyramidGeometry(16, 16), true);
  pyramid.build(image);
  EXPECT_EQ(pyramid.plane(0, kRedGreen).at(8, 8), 0);
  image.at(0, 0) = rgb(60, 60, 60);
  pyramid.build(image);
  EXPECT_EQ(pyramid.plane(0, kRedGreen).at(8, 8), 3 * kHueUnit);
}

ImageGray withPeaks(const std::vector<float>& heights) {
  ImageGray map(40, 8, 0.0f);
  for (std::size_t i = 0; i < heights.size(); ++i) map.at(4 + 6 * static_cast<int>(i), 4) = heights[i];
  return map;
}

// Itti et al. 1998: (M - m)^2 with M = 1 the highest and m the mean of the other peaks.
TEST(Normalisation, MaxFollowsTheFormula) {
  Normaliser normalise(Normalisation::max);
  ImageGray one = withPeaks({5.0f});
  normalise(one, 0.01f);
  EXPECT_FLOAT_EQ(one.at(4, 4), 1.0f);
  ImageGray several = withPeaks({2.0f, 8.0f, 4.0f});
  normalise(several, 0.01f);
  const float factor = (1 - 0.375f) * (1 - 0.375f);
  EXPECT_FLOAT_EQ(several.at(10, 4), factor);
  EXPECT_FLOAT_EQ(several.at(4, 4), 0.25f * factor);
}

// Round hills, so that the difference of Gaussians has something to inhibit.
ImageGray withHills(int perSide) {
  constexpr int kSide = 60;
  ImageGray map(kSide, kSide, 0.0f);
  const int cell = kSide / perSide;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double fromHill = std::hypot(x % cell - cell / 2, y % cell - cell / 2);
      map.at(x, y) = static_cast<float>(std::max(0.0, 1 - fromHill / 4) * (1 - 0.01 * (x / cell)));
    }
  }
  return map;
}

TEST(Normalisation, BothPromoteTheSinglePeakOverManyAlike) {
  for (const Normalisation kind : {Normalisation::max, Normalisation::dog}) {
    Normaliser normalise(kind);
    ImageGray single = withHills(1), many = withHills(5);
    normalise(single, 0.01f);
    normalise(many, 0.01f);
    EXPECT_GT(tests::brightestPlace(single).value, 1.3f * tests::brightestPlace(many).value);
  }
}

TEST(Normalisation, WhatNoDisplayShowsIsNotPromoted) {
  Normaliser normalise(Normalisation::max);
  ImageGray faint = withPeaks({0.1f});
  normalise(faint, 1.0f);
  EXPECT_LE(tests::brightestPlace(faint).value, 0.1f * 0.1f * 0.1f * 1.001f);
}

}  // namespace
}  // namespace saccade::attention
