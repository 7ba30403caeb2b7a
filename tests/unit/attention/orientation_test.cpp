#include "attention/orientation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "attention/saliency.h"
#include "tests/hard_case.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

using core::ImageRgba8;
using tests::rgb;

constexpr int kSide = 256;
constexpr int kLevel = 2;
constexpr std::array kAll{k0Degrees, k45Degrees, k90Degrees, k135Degrees};

struct Channels {
  explicit Channels(const ImageRgba8& image) {
    const auto levels = pyramidGeometry(image.width(), image.height());
    opponent.resize(levels, false);
    opponent.build(image);
    orientation.resize(levels, kLevel);
    orientation.build(opponent);
  }
  OpponentPyramid opponent;
  OrientationPyramid orientation;
};

/// Codes 64 to 192; the normal is turned by `degrees`, counter-clockwise on the screen; the period is the
/// filter's at kLevel.
ImageRgba8 grating(double degrees, double phase) {
  const double k = 2 * std::numbers::pi / (7 * (1 << kLevel)), angle = degrees * std::numbers::pi / 180;
  ImageRgba8 image(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double wave = std::cos(k * (std::cos(angle) * x - std::sin(angle) * y) + phase);
      const int code = static_cast<int>(std::lround(128 + 64 * wave));
      image.at(x, y) = rgb(code, code, code);
    }
  }
  return image;
}

TEST(Orientation, AGratingAnswersInItsOwnDirectionAlone) {
  for (const Orientation own : kAll) {
    for (const double phase : {0.0, 0.7, 2.0}) {
      const Channels c(grating(45 * static_cast<int>(own), phase));
      const int middle = kSide / (2 << kLevel);
      const float response = c.orientation.plane(kLevel, own).at(middle, middle);
      // Contrast of 128 codes of three channels, less what the pyramid's filter takes of this frequency and
      // the mean that the even phase lost.
      EXPECT_GT(response, 0.7f * 3 * 128);
      EXPECT_LT(response, 1.05f * 3 * 128);
      for (const Orientation other : kAll) {
        if (other == own) continue;
        EXPECT_LT(2.5f * c.orientation.plane(kLevel, other).at(middle, middle), response)
            << 45 * own << " degrees seen by " << 45 * other;
      }
    }
  }
}

// The filters as they are defined, 9 x 9 taps at a time.
TEST(Orientation, IsTheEnergyOfGaborFilters) {
  const Channels c(tests::randomDiscs(kSide, kSide, 30, 3));
  const core::ImageGray& intensity = c.opponent.plane(kLevel, kIntensity);
  constexpr double kPeriod = 7, kSigma = kPeriod / 3;
  for (const Orientation own : kAll) {
    const double angle = static_cast<int>(own) * std::numbers::pi / 4, k = 2 * std::numbers::pi / kPeriod;
    const double kx = k * std::cos(angle), ky = -k * std::sin(angle);
    double weights = 0, mean = 0;
    const auto gauss = [&](int x, int y) { return std::exp(-0.5 * (x * x + y * y) / (kSigma * kSigma)); };
    for (int y = -4; y <= 4; ++y) {
      for (int x = -4; x <= 4; ++x) {
        weights += gauss(x, y);
        mean += gauss(x, y) * std::cos(kx * x + ky * y);
      }
    }
    for (const auto& [cx, cy] : {std::pair{5, 5}, {20, 31}, {33, 12}, {50, 47}, {59, 40}}) {
      double even = 0, odd = 0;
      for (int y = -4; y <= 4; ++y) {
        for (int x = -4; x <= 4; ++x) {
          const double value = intensity.at(cx + x, cy + y) * gauss(x, y) / weights;
          even += value * (std::cos(kx * x + ky * y) - mean / weights);
          odd += value * std::sin(kx * x + ky * y);
        }
      }
      EXPECT_NEAR(c.orientation.plane(kLevel, own).at(cx, cy), 4 * std::hypot(even, odd),
                  1e-5 * kIntensityRange)
          << 45 * own << " degrees at " << cx << ", " << cy;
    }
  }
}

// The energy of two phases does not know where the lines are.
TEST(Orientation, TheAnswerIsTheSameWhereverTheLinesLie) {
  for (const Orientation own : kAll) {
    const Channels c(grating(45 * static_cast<int>(own), 0.4));
    const core::ImageGray& plane = c.orientation.plane(kLevel, own);
    float least = 1e9f, most = 0;
    for (int y = 16; y < 48; ++y) {
      for (int x = 16; x < 48; ++x) {
        least = std::min(least, plane.at(x, y));
        most = std::max(most, plane.at(x, y));
      }
    }
    EXPECT_LT(most - least, 0.12f * most) << 45 * own;
  }
}

TEST(Orientation, BrightnessHasNone) {
  for (const int code : {0, 1, 128, 255}) {
    const Channels c(ImageRgba8(64, 48, rgb(code, code, code)));
    for (const Orientation o : kAll) {
      for (int level = kLevel; level < 6; ++level) {
        const auto& pixels = c.orientation.plane(level, o).pixels();
        for (const float v : pixels) {
          ASSERT_EQ(v, pixels.front()) << "the same everywhere";
          ASSERT_LE(v, 1e-3f * kIntensityRange);
        }
      }
    }
  }
}

/// Bars on a grid, all upright but the one that lies.
ImageRgba8 bars(int odd) {
  constexpr int kGrid = 5, kCell = 100;
  ImageRgba8 image(kGrid * kCell, kGrid * kCell, rgb(60, 60, 60));
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int cx = i % kGrid * kCell + kCell / 2, cy = i / kGrid * kCell + kCell / 2;
    const int halfWidth = i == odd ? 24 : 7, halfHeight = i == odd ? 7 : 24;
    for (int y = cy - halfHeight; y < cy + halfHeight; ++y) {
      for (int x = cx - halfWidth; x < cx + halfWidth; ++x) image.at(x, y) = rgb(200, 200, 200);
    }
  }
  return image;
}

// What the channel is for: a bar as bright and as large as the others that lies where they stand.
TEST(Orientation, Hard26TheOnlyLyingBarStandsOut) {
  tests::HardCase off("most salient place from the middle of the only lying bar of 25", "pixels");
  SaliencyModel with({.orientation = true});
  for (int odd = 0; odd < 25; ++odd) {
    const tests::Place at = tests::brightestPlace(with.compute(bars(odd)));
    EXPECT_TRUE(
        off.within(std::hypot(at.x + 0.5 - (odd % 5 * 100 + 50), at.y + 0.5 - (odd / 5 * 100 + 50)), 24 + 16))
        << "bar " << odd;
  }
}

}  // namespace
}  // namespace saccade::attention
