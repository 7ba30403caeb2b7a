// What samples are worth by object: means that forget, and what nothing is known of comes first.
#include "core/corrective/sample_gains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace saccade::core {
namespace {

using Gains = std::vector<float>;
constexpr float kLeast = SampleGains::kLeast;

TEST(SampleGains, AreMeansByObjectAndOneWhereNothingIsKnown) {
  SampleGains gains;
  EXPECT_EQ(gains.byId(3), Gains({1, 1, 1}));
  for (const float change : {0.25f, 0.75f}) gains.add(1, change);
  gains.add(4, 0);
  const Gains byId = gains.byId(6);
  EXPECT_EQ(byId[0], 1);
  EXPECT_FLOAT_EQ(byId[1], 0.5f + kLeast);
  EXPECT_EQ(byId[2], 1);
  EXPECT_EQ(byId[4], kLeast) << "last, but before nothing";
  EXPECT_EQ(byId[5], 1);
  EXPECT_EQ(gains.byId(2).size(), 2u);
  gains.add(2, 1);
  EXPECT_EQ(gains.byId(3)[2], 1) << "never above 1";
}

TEST(SampleGains, WhatCameLastCountsMost) {
  SampleGains gains;
  gains.add(1, 0);
  gains.beginFrame();
  gains.add(1, 0.5f);
  EXPECT_FLOAT_EQ(gains.byId(2)[1], 0.5f / (1 + SampleGains::kKept) + kLeast);
}

TEST(SampleGains, AnObjectWithoutSamplesIsUnknownAgain) {
  constexpr int kSamples = 50;
  SampleGains gains;
  for (int i = 0; i < kSamples; ++i) gains.add(1, 0);
  int frames = 0;
  for (; gains.byId(2)[1] == kLeast; ++frames) gains.beginFrame();
  EXPECT_EQ(gains.byId(2)[1], 1);
  EXPECT_EQ(frames, std::ceil(std::log(1.0 / kSamples) / std::log(SampleGains::kKept)));
}

TEST(SampleGains, WhatIsNotANumberIsIgnored) {
  SampleGains gains;
  gains.add(1, 0.5f);
  gains.add(1, std::numeric_limits<float>::quiet_NaN());
  EXPECT_FLOAT_EQ(gains.byId(2)[1], 0.5f + kLeast);
}

TEST(DisplayedChange, IsWhatADisplayShows) {
  EXPECT_EQ(displayedChange(Vec3(0.3f), Vec3(0.3f)), 0);
  EXPECT_EQ(displayedChange(Vec3(0), Vec3(1)), 1);
  EXPECT_EQ(displayedChange(Vec3(1), Vec3(0)), 1);
  EXPECT_FLOAT_EQ(displayedChange(Vec3(0), Vec3(0.25f, 0, 0)), 0.5f / 3);
  EXPECT_EQ(displayedChange(Vec3(1), Vec3(7)), 0) << "both are white";
  EXPECT_EQ(displayedChange(Vec3(0), Vec3(-2)), 0) << "both are black";
  EXPECT_GT(displayedChange(Vec3(0), Vec3(0.1f)), displayedChange(Vec3(0.5f), Vec3(0.6f)));
}

}  // namespace
}  // namespace saccade::core
