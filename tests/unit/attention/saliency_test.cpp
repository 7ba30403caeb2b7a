#include "attention/saliency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/image_io.h"
#include "tests/hard_case.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

using core::ImageGray;
using core::ImageRgba8;
using core::Rgba8;
using tests::brightestPlace;
using tests::Disc;
using tests::HardCase;
using tests::paint;
using tests::rgb;

const std::vector<SaliencyOptions> kModels{{Normalisation::max, false},
                                           {Normalisation::dog, false},
                                           {Normalisation::max, true},
                                           {Normalisation::dog, true}};

const std::vector<std::pair<int, int>> kSizes{{1, 1},     {2, 1},     {16, 16},   {17, 33},   {64, 48},
                                              {128, 128}, {256, 255}, {333, 257}, {512, 512}, {16, 1000}};

std::string sizeName(const ImageRgba8& image) {
  return std::to_string(image.width()) + " x " + std::to_string(image.height());
}

double largestValue(const ImageGray& map) {
  double largest = 0;
  for (const float v : map.pixels()) {
    if (!(v <= largest)) largest = v;  // keeps a NaN
  }
  return largest;
}

TEST(Saliency, Hard26ConstantImagesOfAnyColourGiveExactlyZero) {
  HardCase salient("saliency of constant images");
  const std::vector<Rgba8> colours{rgb(0, 0, 0),     rgb(255, 255, 255), rgb(255, 0, 0),  rgb(0, 255, 0),
                                   rgb(0, 0, 255),   rgb(255, 255, 0),   rgb(1, 0, 0),    rgb(128, 127, 126),
                                   rgb(37, 211, 89), rgb(251, 3, 177),   rgb(13, 17, 254)};
  for (const SaliencyOptions& kind : kModels) {
    SaliencyModel model(kind);
    for (const auto& [width, height] : kSizes) {
      for (const Rgba8& colour : colours) {
        const ImageRgba8 image(width, height, colour);
        ASSERT_TRUE(salient.within(largestValue(model.compute(image)), 0))
            << sizeName(image) << " of " << int(colour.r) << ", " << int(colour.g) << ", " << int(colour.b);
      }
    }
  }
}

// The model looks at what is displayed: whatever radiance holds is a colour by then.
TEST(Saliency, Hard26RadianceOfNanAndAMillionGivesASoundMap) {
  constexpr int kSide = 128;
  core::ImageRgb radiance(kSide, kSide, core::Vec3(0.2f));
  const auto block = [&](int x0, int y0, float value) {
    for (int y = y0; y < y0 + 12; ++y) {
      for (int x = x0; x < x0 + 12; ++x) radiance.at(x, y) = core::Vec3(value);
    }
  };
  block(20, 90, std::nanf(""));
  block(90, 30, 1e6f);
  block(60, 60, -1e6f);
  block(100, 100, core::kInfinity);
  HardCase unsound =
      HardCase::counting("saliency outside [0, 1] for radiance of NaN, 1e6, -1e6 and infinity", "pixels");
  HardCase constant("saliency of pictures all NaN or all 1e6");
  for (const SaliencyOptions& kind : kModels) {
    const ImageGray map = saliencyOf(core::toDisplay(radiance, 0), kind);
    int wrong = 0;
    for (const float v : map.pixels()) wrong += !(v >= 0 && v <= 1);
    EXPECT_TRUE(unsound.within(wrong, 0));
    for (const float value : {std::nanf(""), 1e6f}) {
      const ImageRgba8 all = core::toDisplay(core::ImageRgb(kSide, kSide, core::Vec3(value)), 0);
      EXPECT_TRUE(constant.within(largestValue(saliencyOf(all, kind)), 0)) << value;
    }
  }
}

TEST(Saliency, AlphaDoesNotCount) {
  ImageRgba8 image = tests::randomDiscs(96, 80, 9, 5);
  const ImageGray opaque = saliencyOf(image, {});
  for (std::size_t i = 0; i < image.pixels().size(); ++i) image.pixels()[i].a = static_cast<std::uint8_t>(i);
  EXPECT_EQ(saliencyOf(image, {}).pixels(), opaque.pixels());
}

struct Contrast {
  const char* name;
  Rgba8 ground, figure;
};
const std::vector<Contrast> kContrasts{{"red on green", rgb(20, 180, 20), rgb(200, 20, 20)},
                                       {"blue on yellow", rgb(200, 200, 30), rgb(30, 30, 220)},
                                       {"bright on dark", rgb(20, 20, 20), rgb(230, 230, 230)},
                                       {"dark on bright", rgb(230, 230, 230), rgb(20, 20, 20)}};

// The map's own resolution: level 4, finer for images with fewer than nine levels.
double mapPixel(const ImageRgba8& image) {
  const std::size_t levels = pyramidGeometry(image.width(), image.height()).size();
  return levels >= 5 ? 1 << (levels - 5) : 1;
}

TEST(Saliency, Hard26OneDiscIsTheMostSalientPlace) {
  HardCase off("most salient place from the middle of the only disc", "pixels");
  SaliencyModel max, dog({Normalisation::dog});
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {64, 64}, {100, 75}, {256, 256}, {333, 257}, {640, 480}, {512, 512}, {1000, 300}}) {
    for (const double share : {0.05, 0.1}) {
      for (const auto& [fx, fy] : {std::pair{0.5, 0.5}, {0.3, 0.6}, {0.82, 0.21}, {0.15, 0.85}}) {
        for (const Contrast& contrast : kContrasts) {
          ImageRgba8 image(width, height, contrast.ground);
          const Disc disc{fx * width, fy * height, std::max(share * std::min(width, height), 3.0)};
          paint(image, disc, contrast.figure);
          for (SaliencyModel* model : {&max, &dog}) {
            const tests::Place at = brightestPlace(model->compute(image));
            EXPECT_TRUE(off.within(std::hypot(at.x + 0.5 - disc.x, at.y + 0.5 - disc.y),
                                   disc.radius + mapPixel(image)))
                << contrast.name << ", " << sizeName(image) << ", disc at " << disc.x << ", " << disc.y
                << " of radius " << disc.radius << ", most salient " << at.x << ", " << at.y
                << (model == &dog ? " (dog)" : " (max)");
          }
        }
      }
    }
  }
}

// As bright as the others: only the one map in which it is alone tells it apart.
TEST(Saliency, Hard26TheOddOneAmongManyStandsOut) {
  HardCase off("most salient place from the middle of the odd one of 25", "pixels");
  constexpr int kGrid = 5, kCell = 100;
  for (int odd = 0; odd < kGrid * kGrid; ++odd) {
    ImageRgba8 image(kGrid * kCell, kGrid * kCell, rgb(90, 90, 90));
    const auto disc = [&](int i) { return Disc{(i % kGrid + 0.5) * kCell, (i / kGrid + 0.5) * kCell, 18.0}; };
    for (int i = 0; i < kGrid * kGrid; ++i)
      paint(image, disc(i), i == odd ? rgb(230, 80, 80) : rgb(130, 130, 130));
    const tests::Place at = brightestPlace(saliencyOf(image, {}));
    EXPECT_TRUE(off.within(std::hypot(at.x + 0.5 - disc(odd).x, at.y + 0.5 - disc(odd).y), 18 + 16))
        << "odd one " << odd;
  }
}

// N(.) taken literally multiplies a map with two equal peaks by 0.
TEST(Saliency, TwoEqualDiscsAreBothSalient) {
  ImageRgba8 image(512, 512, rgb(30, 30, 30));
  paint(image, {128, 256, 25}, rgb(220, 220, 220));
  paint(image, {384, 256, 25}, rgb(220, 220, 220));
  const ImageGray map = saliencyOf(image, {});
  EXPECT_GT(map.at(128, 256), 0.8f);
  EXPECT_GT(map.at(383, 256), 0.8f);
  EXPECT_LT(map.at(256, 40), 0.2f);
}

template <class T>
core::Image<T> mirrored(const core::Image<T>& in) {
  core::Image<T> out(in.width(), in.height());
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) out.at(in.width() - 1 - x, y) = in.at(x, y);
  }
  return out;
}

template <class T>
core::Image<T> turned(const core::Image<T>& in) {
  core::Image<T> out(in.height(), in.width());
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) out.at(in.height() - 1 - y, x) = in.at(x, y);
  }
  return out;
}

float largestDifference(const ImageGray& a, const ImageGray& b) {
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
  float worst = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    worst = std::max(worst, std::abs(a.pixels()[i] - b.pixels()[i]));
  return worst;
}

// Halving and interpolation are symmetric, so only rounding is left: no shift towards a corner at any size.
TEST(Saliency, FollowsMirrorAndQuarterTurn) {
  constexpr float kRounding = 1e-3f;
  for (const SaliencyOptions& kind : kModels) {
    for (const auto& [width, height] :
         std::vector<std::pair<int, int>>{{16, 16}, {17, 33}, {96, 64}, {101, 67}, {256, 256}, {333, 250}}) {
      const ImageRgba8 image = tests::randomDiscs(width, height, 12, 77);
      const ImageGray map = saliencyOf(image, kind);
      EXPECT_LE(largestDifference(saliencyOf(mirrored(image), kind), mirrored(map)), kRounding)
          << sizeName(image);
      EXPECT_LE(largestDifference(saliencyOf(turned(image), kind), turned(map)), kRounding)
          << sizeName(image);
    }
  }
}

// Hue is decoupled from intensity and N(.) stretches every map: half as bright is as salient.
TEST(Saliency, HalvingAllValuesChangesLittle) {
  ImageRgba8 bright = tests::randomDiscs(320, 240, 14, 3);
  ImageRgba8 dim = bright;
  for (std::size_t i = 0; i < bright.pixels().size(); ++i) {
    Rgba8& p = bright.pixels()[i];
    p = rgb(p.r & ~1, p.g & ~1, p.b & ~1);
    dim.pixels()[i] = rgb(p.r / 2, p.g / 2, p.b / 2);
  }
  EXPECT_LE(largestDifference(saliencyOf(bright, {}), saliencyOf(dim, {})), 1e-3f);
}

TEST(Saliency, LiesBetweenZeroAndOneAndReachesTheTop) {
  for (const SaliencyOptions& kind : kModels) {
    for (const auto& [width, height] : kSizes) {
      const ImageRgba8 image = tests::randomDiscs(width, height, 10, 11);
      const ImageGray map = saliencyOf(image, kind);
      ASSERT_EQ(map.width(), width);
      ASSERT_EQ(map.height(), height);
      const auto [least, most] = std::minmax_element(map.pixels().begin(), map.pixels().end());
      EXPECT_GE(*least, 0) << sizeName(image);
      EXPECT_LE(*most, 1) << sizeName(image);
      if (width >= 16 && height >= 16) {
        EXPECT_GT(*most, 0.9f) << sizeName(image);
      }
    }
  }
}

TEST(Saliency, DoesNotDependOnWhatTheModelSawBefore) {
  const ImageRgba8 image = tests::randomDiscs(300, 200, 10, 21);
  for (const SaliencyOptions& kind : kModels) {
    const ImageGray fresh = saliencyOf(image, kind);
    SaliencyModel model(kind);
    model.compute(tests::randomDiscs(300, 200, 10, 22));
    EXPECT_EQ(model.compute(image).pixels(), fresh.pixels());
    model.compute(tests::randomDiscs(64, 500, 10, 23));
    EXPECT_EQ(model.compute(image).pixels(), fresh.pixels());
  }
}

TEST(Saliency, RefusesImpossibleSizesByName) {
  SaliencyModel model;
  EXPECT_THROW(model.compute(ImageRgba8()), core::Error);
  try {
    model.compute(ImageRgba8(SaliencyModel::kLargestSide + 1, 1));
    FAIL() << "8193 pixels were accepted";
  } catch (const core::Error& e) {
    EXPECT_NE(std::string(e.what()).find("8193 x 1"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace saccade::attention
