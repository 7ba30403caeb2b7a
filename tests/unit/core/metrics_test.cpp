// Metrics against their definitions, against known closed forms, and FLIP against its authors' tool.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "core/error.h"
#include "core/image_io.h"
#include "core/metrics/colormap.h"
#include "core/metrics/comparison.h"
#include "core/metrics/flip.h"
#include "core/metrics/separable.h"
#include "core/metrics/ssim.h"
#include "tests/shared_folder.h"

namespace saccade::core {
namespace {

ImageRgba8 noise(int width, int height, std::uint32_t seed, int lo = 0, int hi = 255) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> value(lo, hi);
  ImageRgba8 image(width, height);
  for (Rgba8& p : image.pixels()) {
    p = {static_cast<std::uint8_t>(value(random)), static_cast<std::uint8_t>(value(random)),
         static_cast<std::uint8_t>(value(random)), 255};
  }
  return image;
}

TEST(Comparison, IdenticalImagesDifferByExactlyNothing) {
  for (auto [w, h] : {std::pair{1, 1}, {3, 5}, {11, 11}, {80, 60}}) {
    const ImageRgba8 image = noise(w, h, 1);
    const Comparison c = compareDisplay(image, image);
    EXPECT_EQ(c.rmse, 0);
    EXPECT_EQ(c.relmse, 0);
    EXPECT_EQ(c.psnr, std::numeric_limits<double>::infinity());
    EXPECT_EQ(c.ssim, 1);
    EXPECT_EQ(c.flip, 0);
    EXPECT_EQ(c.flipMedian, 0);
    EXPECT_EQ(c.flipP95, 0);
    EXPECT_EQ(c.maxAbs, 0);
    EXPECT_EQ(c.flipMap.width(), w);
  }
}

TEST(Comparison, ErrorsOfKnownDifferences) {
  ImageRgb reference(2, 1, Vec3(1)), test = reference;
  test.at(1, 0) = Vec3(1, 3, 1);
  const Comparison c = compareLinear(reference, test);
  EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(4.0 / 6));
  EXPECT_DOUBLE_EQ(c.relmse, 4 / (1 + kRelativeEpsilon) / 6);
  EXPECT_EQ(relativeMse(reference, test), c.relmse);
  EXPECT_DOUBLE_EQ(c.psnr, 10 * std::log10(6 / 4.0));
  EXPECT_DOUBLE_EQ(c.maxAbs, 2);
  // Both display as white.
  EXPECT_EQ(c.flip, 0);
  EXPECT_EQ(c.ssim, 1);

  ImageRgba8 dark(4, 4, {10, 10, 10, 255}), light(4, 4, {61, 61, 61, 255});
  const Comparison d = compareDisplay(dark, light);
  EXPECT_NEAR(d.rmse, 0.2, 1e-7);
  EXPECT_NEAR(d.maxAbs, 0.2, 1e-7);
  EXPECT_NEAR(d.psnr, 20 * std::log10(5.0), 1e-5);
}

TEST(Comparison, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(compareDisplay(ImageRgba8(4, 4), ImageRgba8(4, 5)), Error);
  EXPECT_THROW(compareLinear(ImageRgb(3, 4), ImageRgb(4, 3)), Error);
  EXPECT_THROW(compareLinear(ImageRgb(), ImageRgb()), Error);
  ImageRgb bad(4, 4);
  bad.at(2, 1).y = std::numeric_limits<float>::quiet_NaN();
  try {
    compareLinear(ImageRgb(4, 4), bad);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("test image: pixel (2, 1)"), std::string::npos) << e.what();
  }
}

TEST(Separable, EqualsTheSumOverTheWindow) {
  std::mt19937 random(2);
  std::normal_distribution<float> value;
  ImageGray image(13, 7);
  for (float& p : image.pixels()) p = value(random);
  const float kx[] = {0.2f, -1, 3, 0.5f, 7}, ky[] = {1, -2, 0.25f};
  const ImageGray out = filterSeparable(image, kx, ky);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 13; ++x) {
      double sum = 0;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -2; i <= 2; ++i) {
          sum += double{kx[i + 2]} * ky[j + 1] * image.at(std::clamp(x + i, 0, 12), std::clamp(y + j, 0, 6));
        }
      }
      EXPECT_NEAR(out.at(x, y), sum, 1e-4);
    }
  }
}

TEST(Ssim, ConstantImagesGiveTheLuminanceTerm) {
  const ImageRgba8 a(20, 16, {51, 51, 51, 255}), b(20, 16, {102, 102, 102, 255});
  const double expected = (2 * 0.2 * 0.4 + 1e-4) / (0.2 * 0.2 + 0.4 * 0.4 + 1e-4);
  EXPECT_NEAR(ssim(a, b), expected, 1e-4);
}

TEST(Ssim, SymmetricBelowOneAndLowForUnrelatedNoise) {
  const ImageRgba8 a = noise(64, 64, 1), b = noise(64, 64, 2);
  EXPECT_DOUBLE_EQ(ssim(a, b), ssim(b, a));
  EXPECT_LT(std::abs(ssim(a, b)), 0.1);
}

TEST(Flip, AStopRequestEndsIt) {
  std::stop_source stop;
  const ImageRgba8 a = noise(40, 30, 1), b = noise(40, 30, 2);
  EXPECT_EQ(flip(a, b, kFlipPixelsPerDegree, stop.get_token()).pixels(), flip(a, b).pixels());
  stop.request_stop();
  EXPECT_THROW(flip(a, b, kFlipPixelsPerDegree, stop.get_token()), Error);
}

TEST(Flip, SymmetricAndBounded) {
  const ImageRgba8 a = noise(40, 30, 1), b = noise(40, 30, 2);
  const ImageGray ab = flip(a, b), ba = flip(b, a);
  for (std::size_t i = 0; i < ab.pixels().size(); ++i) {
    EXPECT_FLOAT_EQ(ab.pixels()[i], ba.pixels()[i]);
    EXPECT_GE(ab.pixels()[i], 0);
    EXPECT_LE(ab.pixels()[i], 1);
  }
}

TEST(Flip, ConstantImagesGiveTheColourTermAlone) {
  // Filters leave constants alone and features are absent. Greys differ in lightness only; the largest colour
  // difference is that of green and blue, which gives 1.
  const auto constant = [](Rgba8 color) { return ImageRgba8(32, 32, color); };
  const ImageGray extreme = flip(constant({0, 255, 0, 255}), constant({0, 0, 255, 255}));
  for (float v : extreme.pixels()) EXPECT_NEAR(v, 1, 1e-4);
  const double largest = 41.276;  // that difference to the power 0.7
  const double lightness = 116 * std::cbrt(decodeSrgb(100 / 255.0f)) - 16;
  const ImageGray grey = flip(constant({0, 0, 0, 255}), constant({100, 100, 100, 255}));
  const double expected = 0.95 / (0.4 * largest) * std::pow(lightness, 0.7);
  for (float v : grey.pixels()) EXPECT_NEAR(v, expected, 1e-4 * expected);
}

TEST(Flip, ErrorStaysNearWhatChanged) {
  ImageRgba8 a(101, 101, {128, 128, 128, 255}), b = a;
  b.at(50, 50) = {255, 255, 255, 255};
  const ImageGray map = flip(a, b);
  EXPECT_GT(map.at(50, 50), 0.1f);
  for (int y = 0; y < 101; ++y) {
    for (int x = 0; x < 101; ++x) {
      // The widest filter reaches ten pixels.
      if (std::max(std::abs(x - 50), std::abs(y - 50)) > 10) {
        EXPECT_EQ(map.at(x, y), 0);
      }
    }
  }
}

TEST(Flip, WeightedPercentileCountsErrorNotPixels) {
  ImageGray map(10, 1, 0);
  map.at(3, 0) = 0.1f;
  map.at(7, 0) = 0.2f;
  map.at(9, 0) = 0.3f;
  EXPECT_FLOAT_EQ(weightedPercentile(map, 0.1), 0.1f);
  EXPECT_FLOAT_EQ(weightedPercentile(map, 0.45), 0.2f);
  EXPECT_FLOAT_EQ(weightedPercentile(map, 0.95), 0.3f);
  EXPECT_EQ(weightedPercentile(ImageGray(4, 4), 0.5), 0);
  EXPECT_EQ(weightedPercentile(ImageGray(), 0.5), 0);
  EXPECT_NEAR(meanOf(map), 0.06, 1e-7);
}

TEST(Flip, WeightedMeanCountsPixelsByTheirWeights) {
  ImageGray map(2, 2), weights(2, 2);
  map.pixels() = {0.5f, 0.25f, 1, 0};
  weights.pixels() = {1, 0.5f, 0, 0.5f};
  EXPECT_DOUBLE_EQ(weightedMeanOf(map, weights), (0.5 + 0.125) / 2);
  EXPECT_DOUBLE_EQ(weightedMeanOf(map, ImageGray(2, 2, 0.3f)), meanOf(map));
  EXPECT_DOUBLE_EQ(weightedMeanOf(map, ImageGray(2, 2, 0)), meanOf(map));
  EXPECT_EQ(weightedMeanOf({}, {}), 0);
  EXPECT_THROW(weightedMeanOf(map, ImageGray(4, 1, 1)), Error);
}

TEST(Flip, AgreesWithItsAuthorsTool) {
  SACCADE_SHARED_FILE(folder, "references/flip");
  std::ifstream file(folder / "expected.json");
  const auto expected = nlohmann::json::parse(file)["pairs"];
  ASSERT_GE(expected.size(), 4u);
  for (const auto& [name, values] : expected.items()) {
    const Comparison c = compareDisplay(readImage8(folder / (name + "_reference.png")),
                                        readImage8(folder / (name + "_test.png")));
    const double mean = values["mean"], median = values["weighted_median"];
    EXPECT_NEAR(c.flip, mean, 0.01 * mean) << name;
    EXPECT_NEAR(c.flipMedian, median, 0.01 * median) << name;
    EXPECT_NEAR(c.rmse, values["srgb_rmse"].get<double>(), 1e-6) << name;
  }
}

double lightness(const Rgba8& c) {
  const auto linear = [](std::uint8_t v) { return decodeSrgb(static_cast<float>(v) / 255); };
  return luminance(Vec3(linear(c.r), linear(c.g), linear(c.b)));
}

TEST(Colormap, RampRisesInLightnessAndClamps) {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const double now = lightness(rampColor(static_cast<float>(i) / 100));
    EXPECT_GE(now, last);
    last = now;
  }
  EXPECT_LT(lightness(rampColor(0)), 0.001);
  EXPECT_GT(lightness(rampColor(1)), 0.9);
  EXPECT_EQ(rampColor(-5), rampColor(0));
  EXPECT_EQ(rampColor(7), rampColor(1));
  EXPECT_EQ(rampColor(std::numeric_limits<float>::quiet_NaN()), rampColor(0));
}

TEST(Colormap, PaletteTellsIdsApart) {
  std::set<std::uint32_t> seen;
  for (std::uint32_t id = 0; id <= 10000; ++id) {
    const Rgba8 c = paletteColor(id);
    EXPECT_EQ(c.a, 255);
    seen.insert(static_cast<std::uint32_t>(c.r) << 16 | c.g << 8 | c.b);
  }
  EXPECT_EQ(seen.size(), 10001u);
  EXPECT_EQ(paletteColor(0), (Rgba8{0, 0, 0, 255}));
  // The first eight, which levels and threads use, are far apart.
  for (std::uint32_t a = 0; a < 8; ++a) {
    for (std::uint32_t b = a + 1; b <= 8; ++b) {
      const Rgba8 p = paletteColor(a), q = paletteColor(b);
      const int distance = std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b);
      EXPECT_GT(distance, 90) << a << ' ' << b;
    }
  }
}

}  // namespace
}  // namespace saccade::core
