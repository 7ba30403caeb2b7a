// How fast corrections are expected to change: analytic cases of a plane mirror.
#include "core/corrective/change_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace saccade::core {
namespace {

constexpr int kLevel = 5;  // steps of 5 pixels
const Vec3 kEye(0.3f, 1.5f, 2);

Vec3 reflect(const Vec3& toEye, const Vec3& normal) { return 2 * glm::dot(toEye, normal) * normal - toEye; }

/// A point of the mirror y = 0 as a pixel of a grid of 5 pixels that are 0.2 m wide each.
Sample mirrorSample(int column, int row, const std::function<Vec3(const Vec3&)>& environment) {
  Sample s;
  s.x = 5 * column, s.y = 5 * row;
  s.id = 1;
  s.level = kLevel;
  s.position = {0.2f * static_cast<float>(column) - 1, 0, 0.2f * static_cast<float>(row) - 1};
  s.normal = {0, 1, 0};
  s.toEye = glm::normalize(kEye - s.position);
  s.correction = environment(reflect(s.toEye, s.normal));
  return s;
}

std::vector<Sample> mirror(const std::function<Vec3(const Vec3&)>& environment) {
  std::vector<Sample> samples;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 10; ++column) samples.push_back(mirrorSample(column, row, environment));
  estimateChangeRates(samples);
  return samples;
}

TEST(ChangeRate, AMirrorOfSmoothSurroundingsIsForetold) {
  // What is displayed is linear in the reflected direction: `slope` a radian along x and nothing across it.
  for (const float slope : {0.1f, 0.3f, 0.5f}) {
    const auto environment = [&](const Vec3& direction) {
      const float shown = 0.6f + slope * direction.x;
      return Vec3(shown * shown);
    };
    for (const Sample& s : mirror(environment)) {
      for (const Vec3& move : {Vec3(0.1f, 0, 0), Vec3(0, 0.1f, 0.2f), Vec3(-0.3f, 0, 0.1f)}) {
        const Vec3 toEye = glm::normalize(kEye + move - s.position);
        const float turned = glm::length(toEye - s.toEye);
        const float truth =
            std::abs(std::sqrt(environment(reflect(toEye, s.normal)).x) - std::sqrt(s.correction.x));
        // The reflected ray turns by as much as the direction to the eye.
        EXPECT_LE(truth, slope * turned * 1.001f);
        EXPECT_GE(s.changeRate * turned, truth);
        EXPECT_LE(s.changeRate * turned, (slope + 2 * kUsualChangeRate) * turned);
      }
    }
  }
}

TEST(ChangeRate, WhatIsTheSameAllAroundHardlyChanges) {
  for (const Sample& s : mirror([](const Vec3&) { return Vec3(0.4f, 0.2f, -0.1f); })) {
    EXPECT_GE(s.changeRate, kUsualChangeRate);
    EXPECT_LT(s.changeRate, 1.5f * kUsualChangeRate);
  }
}

TEST(ChangeRate, RisesWithContrastAndDensityOfWhatIsReflected) {
  const auto checker = [](float contrast, float squares) {
    return mirror([=](const Vec3& d) {
      const bool odd = static_cast<int>(std::floor(d.x * squares) + std::floor(d.z * squares)) & 1;
      return Vec3(odd ? 0.25f + contrast : 0.25f);
    });
  };
  const auto mean = [](const std::vector<Sample>& samples) {
    float sum = 0;
    for (const Sample& s : samples) sum += s.changeRate;
    return sum / static_cast<float>(samples.size());
  };
  EXPECT_LT(mean(checker(0.1f, 3)), mean(checker(0.5f, 3)));
  EXPECT_LT(mean(checker(0.5f, 1)), mean(checker(0.5f, 8)));
}

TEST(ChangeRate, TwiceTheUsualWithoutNeighbours) {
  std::vector<Sample> samples{mirrorSample(0, 0, [](const Vec3&) { return Vec3(1); }),
                              mirrorSample(9, 9, [](const Vec3&) { return Vec3(0); })};
  estimateChangeRates(samples);
  for (const Sample& s : samples) EXPECT_FLOAT_EQ(s.changeRate, 2 * kUsualChangeRate);
  estimateChangeRates({});
}

TEST(ChangeRate, IsFiniteForAnyCorrection) {
  std::vector<Sample> samples = mirror([](const Vec3& d) { return Vec3(1e30f * d.x, -1e30f, 0); });
  for (const Sample& s : samples)
    EXPECT_TRUE(std::isfinite(s.changeRate) && s.changeRate >= kUsualChangeRate);
}

}  // namespace
}  // namespace saccade::core
