#include "core/metrics/fixation_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/math/random.h"

namespace saccade::core {
namespace {

float random(int i) { return static_cast<float>(hashKey(static_cast<std::uint32_t>(i), 5, 0, 0)) * 0x1p-32f; }

std::vector<float> randomValues(int count, int from) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.push_back(random(from + i));
  return values;
}

ImageGray randomMap(int width, int height) {
  ImageGray map(width, height);
  map.pixels() = randomValues(width * height, 0);
  return map;
}

std::vector<Fixation> randomFixations(int count, int width, int height, int from) {
  std::vector<Fixation> fixations;
  for (int i = 0; i < count; ++i)
    fixations.push_back({random(from + 2 * i) * width, random(from + 2 * i + 1) * height});
  return fixations;
}

TEST(AreaUnderCurve, IsOneForPerfectZeroForContraryHalfForConstantValues) {
  const std::vector<float> low{0, 0.1f, 0.2f}, high{0.3f, 0.4f}, same{0.7f, 0.7f, 0.7f};
  EXPECT_EQ(areaUnderCurve(high, low), 1);
  EXPECT_EQ(areaUnderCurve(low, high), 0);
  EXPECT_EQ(areaUnderCurve(same, same), 0.5);
}

// Counted pair by pair: the definition.
TEST(AreaUnderCurve, IsTheShareOfPairsInTheRightOrder) {
  std::vector<float> positives = randomValues(37, 100), negatives = randomValues(53, 900);
  for (std::vector<float>* values : {&positives, &negatives}) {
    for (float& v : *values) v = std::round(8 * v);  // ties
  }
  double wins = 0;
  for (const float p : positives) {
    for (const float n : negatives) wins += p > n ? 1 : p == n ? 0.5 : 0;
  }
  EXPECT_DOUBLE_EQ(areaUnderCurve(positives, negatives), wins / (37 * 53));
  EXPECT_DOUBLE_EQ(areaUnderCurve(negatives, positives), 1 - wins / (37 * 53));
}

TEST(AreaUnderCurve, KnowsOnlyTheOrderOfValues) {
  std::vector<float> positives = randomValues(40, 0), negatives = randomValues(400, 40);
  const double before = areaUnderCurve(positives, negatives);
  for (std::vector<float>* values : {&positives, &negatives}) {
    for (float& v : *values) v = std::exp(5 * v) - 3;
  }
  EXPECT_EQ(areaUnderCurve(positives, negatives), before);
}

TEST(ResizedByArea, KeepsTheMeanAndConstantsAndItself) {
  const ImageGray map = randomMap(61, 47);
  EXPECT_EQ(resizedByArea(map, 61, 47).pixels(), map.pixels());
  const auto meanOf = [](const ImageGray& image) {
    return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0) /
           static_cast<double>(image.pixels().size());
  };
  for (const auto& [width, height] : {std::pair{200, 150}, {7, 5}, {1, 1}, {122, 94}}) {
    const ImageGray resized = resizedByArea(map, width, height);
    ASSERT_EQ(resized.width(), width);
    ASSERT_EQ(resized.height(), height);
    EXPECT_NEAR(meanOf(resized), meanOf(map), 1e-6);
    const ImageGray constant = resizedByArea(ImageGray(61, 47, 0.25f), width, height);
    for (const float v : constant.pixels()) EXPECT_FLOAT_EQ(v, 0.25f);
  }
}

TEST(ResizedByArea, HalvesToTheMeansOfFour) {
  const ImageGray map = randomMap(8, 6), half = resizedByArea(map, 4, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      EXPECT_FLOAT_EQ(half.at(x, y), (map.at(2 * x, 2 * y) + map.at(2 * x + 1, 2 * y) +
                                      map.at(2 * x, 2 * y + 1) + map.at(2 * x + 1, 2 * y + 1)) /
                                         4);
    }
  }
}

// A map that is bright in one place, where everybody looked: no pixel is above the fixated ones, which are
// among all pixels themselves and tie with half of their number.
TEST(FixationScores, APerfectMapScoresOneUpToTheFixatedPixelsThemselves) {
  ImageGray map(kScoredWidth, kScoredHeight);
  map.at(20, 30) = 1;
  const std::vector<Fixation> own{{20.5f, 30.5f}, {20.1f, 30.9f}}, others{{100, 100}, {3, 140}};
  const auto scores = scoreFixations(map, own, others);
  ASSERT_TRUE(scores);
  constexpr double kPixels = kScoredWidth * kScoredHeight;
  EXPECT_DOUBLE_EQ(scores->auc, 1 - 0.5 / kPixels);
  EXPECT_EQ(scores->shuffledAuc, 1.0);
  // Mean 1/n, variance 1/n - 1/n^2: the one bright pixel is sqrt(n - 1) deviations above.
  EXPECT_NEAR(scores->nss, std::sqrt(kPixels - 1), 1e-6);
  EXPECT_EQ(scores->fixations, 2);
}

TEST(FixationScores, AConstantMapIsChance) {
  for (const auto& [width, height] : {std::pair{1, 1}, {800, 600}, {16, 999}}) {
    const auto scores = scoreFixations(ImageGray(width, height, 0.3f), randomFixations(20, width, height, 0),
                                       randomFixations(30, width, height, 50));
    ASSERT_TRUE(scores);
    EXPECT_EQ(scores->auc, 0.5);
    EXPECT_EQ(scores->shuffledAuc, 0.5);
    EXPECT_EQ(scores->nss, 0);
  }
}

// The mean of the z-scored map over all of its own pixels is 0.
TEST(FixationScores, LookingEverywhereIsChance) {
  const ImageGray map = randomMap(kScoredWidth, kScoredHeight);
  std::vector<Fixation> everywhere;
  for (int y = 0; y < kScoredHeight; ++y) {
    for (int x = 0; x < kScoredWidth; ++x) everywhere.push_back({x + 0.5f, y + 0.5f});
  }
  const auto scores = scoreFixations(map, everywhere, everywhere);
  EXPECT_NEAR(scores->auc, 0.5, 1e-12);
  EXPECT_NEAR(*scores->shuffledAuc, 0.5, 1e-12);
  EXPECT_NEAR(scores->nss, 0, 1e-9);
}

TEST(FixationScores, ScaleAndOffsetOfTheMapDoNotCount) {
  ImageGray map = randomMap(300, 200);
  const std::vector<Fixation> own = randomFixations(50, 300, 200, 7),
                              others = randomFixations(90, 300, 200, 999);
  const auto before = scoreFixations(map, own, others);
  for (float& v : map.pixels()) v = 4 * v + 2;
  const auto after = scoreFixations(map, own, others);
  EXPECT_NEAR(after->nss, before->nss, 1e-4);
  EXPECT_NEAR(after->auc, before->auc, 1e-4);
  EXPECT_NEAR(*after->shuffledAuc, *before->shuffledAuc, 1e-4);
}

// Left half bright, fixations scaled from the picture's pixels to the scored map's.
TEST(FixationScores, PositionsAreInThePicturesPixels) {
  for (const auto& [width, height] : {std::pair{800, 600}, {50, 40}, {200, 150}, {1600, 10}}) {
    ImageGray map(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width / 2; ++x) map.at(x, y) = 1;
    }
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const std::vector<Fixation> left{{0, 0}, {0.49f * w, 0.99f * h}},
        right{{0.51f * w, 0}, {w - 0.01f, h - 0.01f}};
    EXPECT_EQ(scoreFixations(map, left, right)->shuffledAuc, 1.0) << width;
    EXPECT_NEAR(scoreFixations(map, left, {})->nss, 1, 1e-6);
    EXPECT_NEAR(scoreFixations(map, right, {})->nss, -1, 1e-6);
  }
}

TEST(FixationScores, WhatLiesOutsideDoesNotCount) {
  const ImageGray map = randomMap(100, 80);
  const std::vector<Fixation> outside{{-0.1f, 5}, {100, 5}, {5, 80}, {5, -3}, {1e30f, 1e30f}};
  EXPECT_FALSE(scoreFixations(map, outside, {}));
  std::vector<Fixation> own = randomFixations(9, 100, 80, 1);
  const auto alone = scoreFixations(map, own, {});
  own.insert(own.end(), outside.begin(), outside.end());
  const auto both = scoreFixations(map, own, outside);
  EXPECT_EQ(both->auc, alone->auc);
  EXPECT_EQ(both->nss, alone->nss);
  EXPECT_EQ(both->fixations, 9);
  EXPECT_FALSE(both->shuffledAuc) << "nobody looked elsewhere";
}

}  // namespace
}  // namespace saccade::core
