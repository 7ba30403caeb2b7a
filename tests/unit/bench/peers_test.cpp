// Seconds to equal error, Cycles' output, and where the rest of an error is.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/peers/contender.h"
#include "bench/peers/curve.h"
#include "bench/peers/cycles.h"
#include "bench/peers/rest.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

TEST(SecondsToError, IsExactForNoiseThatHalvesWithTwiceTheTime) {
  std::vector<CurvePoint> curve;
  for (const double seconds : {1.0, 3.0, 20.0, 100.0}) curve.push_back({seconds, 0.7 / seconds});
  for (const double seconds : {1.5, 3.0, 7.0, 99.0}) {
    const auto reached = secondsToError(curve, 0.7 / seconds);
    ASSERT_TRUE(reached);
    EXPECT_NEAR(reached->seconds, seconds, 1e-9 * seconds);
    EXPECT_FALSE(reached->atMost);
  }
}

TEST(SecondsToError, TheOrderOfThePointsDoesNotMatter) {
  const std::vector<CurvePoint> curve = {{8, 0.1}, {1, 0.9}, {2, 0.4}};
  const std::vector<CurvePoint> sorted = {{1, 0.9}, {2, 0.4}, {8, 0.1}};
  EXPECT_EQ(secondsToError(curve, 0.2)->seconds, secondsToError(sorted, 0.2)->seconds);
}

TEST(SecondsToError, SaysWhenTheCheapestPointIsBetterAndWhenNoneIsGoodEnough) {
  const std::vector<CurvePoint> curve = {{1, 0.5}, {4, 0.25}};
  const auto cheap = secondsToError(curve, 0.6);
  ASSERT_TRUE(cheap);
  EXPECT_EQ(cheap->seconds, 1);
  EXPECT_TRUE(cheap->atMost);
  EXPECT_FALSE(secondsToError(curve, 0.5)->atMost);
  EXPECT_FALSE(secondsToError(curve, 0.2));
  EXPECT_FALSE(secondsToError({}, 0.2));
}

TEST(SecondsToError, TakesTheFirstCrossing) {
  // A curve that rises again, as one picture's luck may make it.
  const auto reached = secondsToError({{1, 0.4}, {2, 0.1}, {4, 0.2}, {8, 0.05}}, 0.1);
  ASSERT_TRUE(reached);
  EXPECT_DOUBLE_EQ(reached->seconds, 2);
}

Trial trialOf(std::vector<double> seconds, std::vector<double> errors) {
  Trial trial;
  trial.seconds = std::move(seconds);
  trial.errors = std::move(errors);
  return trial;
}

TEST(SecondsTo, RunsAlongTheMediansAndAddsTheBaking) {
  const std::vector<Trial> trials = {trialOf({1, 1.1, 0.9}, {0.4, 0.4, 0.4}),
                                     trialOf({4, 5, 3}, {0.1, 0.11, 0.09})};
  const auto ready = secondsTo(trials, 0.1, {});
  ASSERT_TRUE(ready);
  EXPECT_DOUBLE_EQ(ready->seconds.median, 4);
  EXPECT_DOUBLE_EQ(ready->seconds.min, 3);
  EXPECT_DOUBLE_EQ(ready->seconds.max, 5);
  const auto baked = secondsTo(trials, 0.1, {10, 12, 11});
  EXPECT_DOUBLE_EQ(baked->seconds.median, 15);
  EXPECT_DOUBLE_EQ(baked->seconds.min, 13);
  EXPECT_DOUBLE_EQ(baked->seconds.max, 17);
  EXPECT_EQ(baked->seconds.repeats, 3);
  EXPECT_FALSE(secondsTo(trials, 0.05, {}));
}

TEST(SecondsTo, TheRangeOfAQuotientIsTheWidest) {
  const Value a = Value::seconds({8, 10, 12}), b = Value::seconds({1, 2, 4});
  const Value q = quotient(a, b);
  EXPECT_DOUBLE_EQ(q.median, 5);
  EXPECT_DOUBLE_EQ(q.min, 2);
  EXPECT_DOUBLE_EQ(q.max, 12);
  EXPECT_EQ(q.kind, Kind::ratio);
}

TEST(Cycles, ItsResultIsFoundAmongWhatBlenderPrints) {
  const CyclesPicture picture = parseCyclesOutput(
      "Blender 3.4.1\nData are loaded\nFra:1 Mem:20M | {not json\n\n{\"blender\": \"3.4.1\", \"import_s\": "
      "0.25, "
      "\"spp\": 16, \"render_s\": 8.5, \"file\": \"/tmp/a b/cycles_16.exr\"}\n\nBlender quit\n");
  EXPECT_EQ(picture.renderSeconds, 8.5);
  EXPECT_EQ(picture.importSeconds, 0.25);
  EXPECT_EQ(picture.file, "/tmp/a b/cycles_16.exr");
}

TEST(Cycles, NoResultIsAnError) {
  for (const char* output : {"", "Blender 3.4.1\nTraceback\nBlender quit\n", "{\"render_s\": 1}\n",
                             "{\"render_s\": \"soon\", \"import_s\": 1, \"file\": \"a\"}\n"})
    EXPECT_THROW(parseCyclesOutput(output), core::Error) << output;
}

TEST(Cycles, ABakeHasAValueForEachPoint) {
  const std::string printed = "Blender\n{\"blender\": \"3.4.1\", \"bake_s\": 28.5, \"unwrap_s\": 0.5}\n";
  const CyclesBake bake = parseCyclesBake(printed, "[[1, 2, 3], [0, 0.5, 0]]", 2);
  EXPECT_EQ(bake.bakeSeconds, 28.5);
  EXPECT_EQ(bake.unwrapSeconds, 0.5);
  EXPECT_EQ(bake.irradiance, (std::vector<core::Vec3>{{1, 2, 3}, {0, 0.5f, 0}}));
  for (const char* values : {"", "[[1, 2, 3]]", "[[1, 2], [3, 4]]", "[1, 2]", "{}"})
    EXPECT_THROW(parseCyclesBake(printed, values, 2), core::Error) << values;
  EXPECT_THROW(parseCyclesBake("Blender quit\n", "[[1, 2, 3], [0, 0.5, 0]]", 2), core::Error);
}

TEST(ErrorWithoutNoise, NeverFallsBelowATenthOfTheReferencesOwn) {
  core::Comparison measured;
  measured.relmse = 0.012;
  EXPECT_DOUBLE_EQ(errorWithoutNoise(measured, 0.002), 0.01);
  measured.relmse = 0.001;
  EXPECT_DOUBLE_EQ(errorWithoutNoise(measured, 0.002), 0.0002);
}

/// 8 x 8, left half object 1, right half diffuse, whose lower rows are brighter.
core::FrameSnapshot halves() {
  core::FrameSnapshot frame;
  core::Bounds bounds;
  bounds.add(core::Vec3(-1));
  bounds.add(core::Vec3(1));
  frame.view = core::View(core::Camera{}, 8, 8, bounds);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) frame.baseAndId.emplace_back(core::Vec3(y < 4 ? 1.0f : 1.1f), x < 4 ? 1 : 0);
  }
  frame.baseAndId[frame.index(7, 7)] = core::Vec4(5, 5, 5, 0);
  core::measureExtents(frame, 1, 1);
  return frame;
}

TEST(Rest, EveryPixelIsOfOnePart) {
  const core::FrameSnapshot frame = halves();
  EXPECT_EQ(partOf(frame, 0, 0), Part::corrected);
  EXPECT_EQ(partOf(frame, 2, 7), Part::corrected);
  EXPECT_EQ(partOf(frame, 3, 3), Part::edge);  // beside the other object
  EXPECT_EQ(partOf(frame, 4, 0), Part::edge);
  EXPECT_EQ(partOf(frame, 5, 4), Part::maps);  // a tenth brighter is no edge
  EXPECT_EQ(partOf(frame, 6, 6), Part::edge);  // beside the bright one
  EXPECT_EQ(partOf(frame, 7, 7), Part::edge);
}

TEST(Rest, SharesSumToTheWholeAndKnowTheNoiseOfTheReference) {
  const core::FrameSnapshot frame = halves();
  core::ImageRgb low(8, 8), high(8, 8), picture(8, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      low.at(x, y) = core::Vec3(0.9f);
      high.at(x, y) = core::Vec3(1.1f);
      picture.at(x, y) = core::Vec3(x < 4 ? 1.5f : 1.0f);
    }
  }
  ReferenceSums reference(8, 8);
  reference.add(0, low, 1);
  reference.add(1, high, 1);
  reference.samplesPerHalf = 1;
  const auto shares = sharesOfError(picture, reference, frame);
  double area = 0, sum = 0;
  for (const Share& share : shares) {
    area += share.area;
    sum += share.relmse;
  }
  EXPECT_NEAR(area, 1, 1e-12);
  // Half of the picture is off by 0.5 around a mean of 1, whose own squared error is 0.01.
  EXPECT_NEAR(sum, (0.5 * 0.25 - 0.01) / 1.01, 1e-6);
  const auto maps = static_cast<std::size_t>(Part::maps);
  EXPECT_NEAR(shares[maps].relmse, -0.01 / 1.01 * shares[maps].area, 1e-6);
}

}  // namespace
}  // namespace saccade::bench
