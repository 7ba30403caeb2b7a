// A recorded walk and its replay are the same pictures, whatever happened in between.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "app/recording/session_check.h"
#include "core/error.h"
#include "tests/unit/app/recording_fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using tests::cameraAt;
using tests::firstDifference;
using tests::kSmall;
using tests::recordWalk;
using tests::replayed;

std::filesystem::path output(const std::string& name) { return tests::temporaryFolder() / name; }

TEST(Recording, ReplaysAWalkWithoutTracersBitForBit) {
  const auto file = output("inline.session");
  const tests::Pictures shown = recordWalk(file, {.threads = 0}, 12, [](FrameLoop& loop, int i) {
    loop.step(cameraAt(0.2 * (i / 2)), kSmall, FrameBudget::untilDeadline(std::chrono::milliseconds(2)));
  });
  const tests::Replayed again = replayed(file);
  EXPECT_EQ(firstDifference(shown, again.shown), -1);
  EXPECT_TRUE(again.warnings.empty());
  EXPECT_GT(tests::askedOf(file, "SELECT sum(samples) FROM batches"), 1000);
}

// Tracers go on with the last camera while the next is drawn: batches arrive late.
TEST(Recording, ReplaysAWalkWithTracersAndLateBatchesBitForBit) {
  const auto file = output("threads.session");
  const tests::Pictures shown =
      recordWalk(file, {.threads = 2, .asynchronousAnalysis = true}, 40, [](FrameLoop& loop, int i) {
        loop.step(cameraAt(0.04 * i), kSmall, FrameBudget::untilDeadline(std::chrono::milliseconds(8)));
      });
  EXPECT_EQ(firstDifference(shown, replayed(file).shown), -1);
}

TEST(Recording, SamplesOfOlderCamerasAreReplayedInTheirPlace) {
  const auto file = output("late.session");
  core::SampleBatch kept;
  const tests::Pictures shown = recordWalk(file, {.threads = 0}, 8, [&](FrameLoop& loop, int i) {
    // Every batch is swapped for the one before it: each arrives one late, some under the next camera.
    loop.onBatch = [&](core::SampleBatch& batch) { std::swap(batch, kept); };
    if (kept.epoch == 0) kept.epoch = 1;
    loop.step(cameraAt(0.1 * i), kSmall, FrameBudget::untilDeadline(std::chrono::milliseconds(2)));
  });
  EXPECT_EQ(firstDifference(shown, replayed(file).shown), -1);
  EXPECT_GT(
      tests::askedOf(
          file, "SELECT count(*) FROM batches JOIN frames USING(frame) WHERE batches.epoch < frames.epoch"),
      0);
}

TEST(Recording, SettingsThatChangeAndWindowsThatAreResizedAreReplayed) {
  const auto file = output("settings.session");
  const tests::Pictures shown = recordWalk(file, {.threads = 0}, 16, [](FrameLoop& loop, int i) {
    if (i == 2) loop.setExposure(1.5f);
    if (i == 4) loop.setDelta(0.02f);
    if (i == 6) loop.showCorrections(false);
    if (i == 8) loop.showCorrections(true);
    if (i == 9) loop.reuseSamples(false);
    if (i == 11) loop.reuseSamples(true);
    if (i == 12) loop.setAttention(1);
    if (i == 13) loop.invalidate();
    const app::ImageSize size = i < 10 ? kSmall : app::ImageSize{80, 48};
    loop.step(cameraAt(0.1 * (i - i % 2)), size, FrameBudget::firstSamples(300));
  });
  EXPECT_EQ(firstDifference(shown, replayed(file).shown), -1);
  EXPECT_EQ(tests::askedOf(file, "SELECT count(*) FROM settings WHERE frame = 0"), 10) << "all";
  EXPECT_EQ(tests::askedOf(file, "SELECT count(*) FROM settings WHERE frame > 0"), 7) << "changes alone";
  EXPECT_EQ(tests::askedOf(file, "SELECT value FROM settings WHERE frame = 12 AND name = 'attention'"), 1);
}

TEST(Recording, WithoutACacheNothingIsKept) {
  const auto file = output("nocache.session");
  app::FrameLoopOptions options{.threads = 0};
  options.corrective.cacheMb = 0;
  const tests::Pictures shown = recordWalk(file, options, 4, [](FrameLoop& loop, int i) {
    loop.step(cameraAt(0.1 * i), kSmall, FrameBudget::firstSamples(200));
  });
  EXPECT_EQ(firstDifference(shown, replayed(file).shown), -1);
}

TEST(Recording, AConvergedPictureReplays) {
  const auto file = output("converged.session");
  const tests::Pictures shown = recordWalk(file, {.threads = 2}, 3, [](FrameLoop& loop, int i) {
    loop.step(cameraAt(0.1 * std::min(i, 1)), kSmall,
              i < 2 ? FrameBudget::firstSamples(100) : FrameBudget::untilConverged());
  });
  EXPECT_EQ(firstDifference(shown, replayed(file).shown), -1);
}

core::Sample anySample(std::mt19937& random) {
  core::Sample s;
  auto* bytes = reinterpret_cast<std::uint8_t*>(&s.correction);
  for (std::size_t i = 0; i < 3 * sizeof(core::Vec3) + 2 * sizeof(float); ++i)
    bytes[i] = static_cast<std::uint8_t>(random());
  s.x = static_cast<std::int32_t>(random() % 16384);
  s.y = static_cast<std::int32_t>(random() % 16384);
  s.id = static_cast<std::uint32_t>(random());
  s.level = static_cast<std::uint8_t>(random());
  s.thread = static_cast<std::uint8_t>(random());
  s.fromDepth = random() % 2 == 0;
  return s;
}

TEST(SessionFormat, SamplesKeepEveryBit) {
  std::mt19937 random(7);
  std::vector<core::Sample> samples;
  for (int i = 0; i < 1000; ++i) samples.push_back(anySample(random));
  const std::vector<std::uint8_t> bytes = app::encodeSamples(samples);
  EXPECT_EQ(bytes.size(), samples.size() * app::kSampleBytes);
  const std::vector<core::Sample> back = app::decodeSamples(bytes, app::kSampleBytes);
  ASSERT_EQ(back.size(), samples.size());
  EXPECT_EQ(app::encodeSamples(back), bytes);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(back[i].x, samples[i].x);
    EXPECT_EQ(back[i].fromDepth, samples[i].fromDepth);
    EXPECT_EQ(std::memcmp(&back[i].correction, &samples[i].correction, sizeof(core::Vec3)), 0);
    EXPECT_EQ(std::memcmp(&back[i].viewDepth, &samples[i].viewDepth, sizeof(float)), 0);
  }
}

// The layout of docs/session-format.md, byte by byte.
TEST(SessionFormat, ASampleLiesAsDocumented) {
  core::Sample s;
  s.x = 0x0102, s.y = 0x0304, s.id = 0x05060708, s.level = 7, s.thread = 3, s.fromDepth = true;
  s.correction = {1, 2, 3}, s.position = {4, 5, 6}, s.normal = {7, 8, 9}, s.cosView = 10, s.viewDepth = 11;
  s.toEye = {12, 13, 14}, s.changeRate = 15;
  const std::vector<std::uint8_t> bytes = app::encodeSamples(std::span(&s, 1));
  const std::vector<std::uint8_t> head{2, 1, 4, 3, 8, 7, 6, 5, 7, 3, 1, 0};
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  for (int i = 0; i < 15; ++i) {
    float value = 0;
    std::memcpy(&value, bytes.data() + 12 + 4 * i, 4);
    EXPECT_EQ(value, static_cast<float>(i + 1));
  }
}

TEST(SessionFormat, SamplesOfLongerRecordsAreReadByTheirHead) {
  std::mt19937 random(7);
  const std::vector<core::Sample> samples{anySample(random), anySample(random)};
  const std::vector<std::uint8_t> bytes = app::encodeSamples(samples);
  std::vector<std::uint8_t> longer;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(i * app::kSampleBytes);
    longer.insert(longer.end(), at, at + static_cast<std::ptrdiff_t>(app::kSampleBytes));
    longer.insert(longer.end(), 12, 0xee);
  }
  EXPECT_EQ(app::encodeSamples(app::decodeSamples(longer, app::kSampleBytes + 12)), bytes);
}

TEST(SessionFormat, TilesAreMeansOfTheirPixels) {
  core::ImageRgba8 image(100, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 100; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(80 * y), 200};
  }
  const std::vector<std::uint8_t> means = app::tileMeans(image);
  ASSERT_EQ(means.size(), 32u * 3 * 3);
  EXPECT_EQ(means[0], 1) << "columns 0 to 2";
  EXPECT_EQ(means[3 * 31], 98) << "columns 96 to 99, rounded";
  EXPECT_EQ(means[3 * 64 + 1], 160);
  for (std::size_t i = 2; i < means.size(); i += 3) EXPECT_EQ(means[i], 200);
  EXPECT_EQ(app::tileMeans(core::ImageRgba8(1, 1, {1, 2, 3, 255})), (std::vector<std::uint8_t>{1, 2, 3}));
}

TEST(SessionFormat, AHashTellsEveryPixelAndTheShape) {
  const core::ImageRgba8 image(24, 10);
  const std::uint64_t hash = app::frameHash(image);
  for (const int i : {0, 1, 117, 239}) {
    core::ImageRgba8 other = image;
    other.pixels()[static_cast<std::size_t>(i)].b ^= 1;
    EXPECT_NE(app::frameHash(other), hash);
  }
  EXPECT_NE(app::frameHash(core::ImageRgba8(10, 24)), hash);
}

// Hashes bind to the machine: elsewhere the tiles decide.
TEST(SessionCheck, OnAnotherMachineTilesDecide) {
  const app::RecordedOn here{"osmesa", "llvmpipe", "cpu"}, other{"osmesa", "llvmpipe", "another"};
  core::ImageRgba8 image(64, 64, {100, 100, 100, 255});
  app::RecordedFrame frame;
  frame.hash = app::frameHash(image);
  frame.tiles = app::tileMeans(image);
  core::ImageRgba8 oneOff = image;
  oneOff.at(5, 5).r = 101;
  core::ImageRgba8 wrong = image;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) wrong.at(x, y).g = static_cast<std::uint8_t>(100 + app::kTileTolerance + 1);
  }
  app::SessionCheck same(here, here);
  EXPECT_FALSE(same.difference(frame, image));
  EXPECT_TRUE(same.difference(frame, oneOff)) << "bit for bit";
  app::RecordedOn older = here;
  --older.format;
  EXPECT_FALSE(app::SessionCheck(older, here).difference(frame, oneOff)) << "another version's ranks";
  app::SessionCheck elsewhere(other, here);
  EXPECT_FALSE(elsewhere.difference(frame, image));
  EXPECT_FALSE(elsewhere.difference(frame, oneOff));
  EXPECT_TRUE(elsewhere.difference(frame, wrong));
  EXPECT_EQ(elsewhere.equal(), 1);
  EXPECT_EQ(elsewhere.similar(), 1);
  EXPECT_EQ(elsewhere.largestTileDifference(), app::kTileTolerance + 1);
}

}  // namespace
}  // namespace saccade
