// The correction layer against the rule of its header, told in the plainest way: for every pixel, the best of
// all samples that cover it.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>
#include <tuple>

#include "render/splat/correction_layer.h"
#include "tests/unit/render/splat_fixture.h"

namespace saccade::render {
namespace {

using core::Sample;
using core::Vec2;
using core::Vec3;
using core::Vec4;
using namespace testing;

/// A sample with its place in the image under test.
struct Placed {
  Sample sample;
  Vec2 pixel{0};
  int footprint = 1;
  int age = 0;
  bool warped = false;
};

void splat(CorrectionLayer& layer, const Placed& p) {
  const Sample& s = p.sample;
  if (p.warped) {
    layer.splatWarped({s.correction, s.x, s.y, static_cast<std::uint16_t>(p.age), s.level, s.thread,
                       static_cast<std::uint8_t>(p.footprint)},
                      s.id, p.pixel);
  } else {
    layer.splat(s);
  }
}

int rankedLevel(const Placed& p) {
  return p.warped ? core::effectiveLevel(p.sample.level, p.age) : p.sample.level;
}

/// Smaller is better; nothing where the sample does not reach the pixel.
using Order = std::tuple<int, int, int, int, int, int, int, int, int, int, int>;
std::optional<Order> orderAt(const core::FrameSnapshot& frame, const Placed& p, int x, int y) {
  if (p.sample.id == 0 || frame.idAt(x, y) != p.sample.id) return std::nullopt;
  const int cx = p.warped ? static_cast<int>(std::floor(p.pixel.x)) : p.sample.x;
  const int cy = p.warped ? static_cast<int>(std::floor(p.pixel.y)) : p.sample.y;
  const int half = (p.warped ? p.footprint : core::Lattice::splatSide(p.sample.level)) / 2;
  const int dx = x - cx, dy = y - cy;
  if (std::abs(dx) > half || std::abs(dy) > half) return std::nullopt;
  const bool exact = !p.warped && dx == 0 && dy == 0;
  return Order{exact ? 0 : 1,
               exact ? 0 : -rankedLevel(p),
               p.warped ? 1 : 0,
               dx * dx + dy * dy,
               cy,
               cx,
               p.age,
               p.sample.y,
               p.sample.x,
               -p.sample.level,
               p.sample.thread};
}

const Placed* bestAt(const core::FrameSnapshot& frame, const std::vector<Placed>& all, int x, int y) {
  const Placed* best = nullptr;
  std::optional<Order> bestOrder;
  for (const Placed& p : all) {
    const auto order = orderAt(frame, p, x, y);
    if (order && (!bestOrder || *order < *bestOrder)) best = &p, bestOrder = order;
  }
  return best;
}

void expectShows(CorrectionLayer& layer, const core::FrameSnapshot& frame, const std::vector<Placed>& all) {
  const auto pixels = layer.pixels();
  const std::vector<std::uint8_t> levels = layer.levels();
  ASSERT_EQ(levels.size(), pixels.size());
  std::uint32_t covered = 0, exact = 0;
  for (int y = 0; y < layer.height(); ++y) {
    for (int x = 0; x < layer.width(); ++x) {
      const Placed* best = bestAt(frame, all, x, y);
      const CorrectionLayer::Splat* shown = layer.shownAt(x, y);
      ASSERT_EQ(best != nullptr, shown != nullptr) << x << ", " << y;
      if (!best) {
        ASSERT_EQ(pixels[frame.index(x, y)], Vec4(0)) << x << ", " << y;
        ASSERT_EQ(levels[frame.index(x, y)], 0);
        continue;
      }
      ++covered;
      const bool isExact = !best->warped && best->sample.x == x && best->sample.y == y;
      exact += isExact;
      ASSERT_EQ(levels[frame.index(x, y)], isExact ? core::Lattice::kMaxLevel + 1 : rankedLevel(*best));
      ASSERT_EQ(layer.isExact(x, y), isExact) << x << ", " << y;
      ASSERT_EQ(pixels[frame.index(x, y)], Vec4(best->sample.correction, 0)) << x << ", " << y;
      ASSERT_EQ(shown->level, best->sample.level);
      ASSERT_EQ(shown->thread, best->sample.thread);
      ASSERT_EQ(shown->ageFrames, best->age);
      ASSERT_EQ(shown->x, best->sample.x);
      ASSERT_EQ(shown->y, best->sample.y);
    }
  }
  EXPECT_EQ(layer.coveredCount(), covered);
  EXPECT_EQ(layer.exactCount(), exact);
}

/// Blocks of ids, some of them above 255 and above 65535, and diffuse pixels between.
std::uint32_t blockId(int x, int y) {
  constexpr std::uint32_t ids[] = {1, 0, 300, 256, 70000, 1};
  return ids[static_cast<std::size_t>((x / 11 + 3 * (y / 7)) % 6)];
}

std::vector<Placed> randomSamples(const core::FrameSnapshot& frame, int count, std::mt19937& random) {
  const int w = frame.view.width(), h = frame.view.height();
  const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<Placed> all;
  for (int i = 0; i < count; ++i) {
    Placed p;
    p.sample = sampleAt(frame, upTo(w), upTo(h), 1 + upTo(7));
    p.warped = upTo(3) != 0;
    if (p.warped) {
      // Samples from a larger image than this: centres outside included, several to a pixel.
      p.pixel = {static_cast<float>(upTo(4 * (w + 40))) / 4 - 20,
                 static_cast<float>(upTo(4 * (h + 40))) / 4 - 20};
      p.sample.id = blockId(upTo(w), upTo(h));
      p.footprint = upTo(4) == 0 ? 1 + 2 * upTo(81) : 1 + 2 * upTo(8);
      p.age = upTo(2) == 0 ? upTo(4) : upTo(60);
    }
    // Decided by what was traced, as a tracer's is.
    p.sample.thread = static_cast<std::uint8_t>((p.sample.x + p.sample.level) % 5);
    p.sample.correction.z = static_cast<float>(p.sample.thread + 8 * p.sample.level);
    all.push_back(p);
    if (upTo(20) == 0) all.push_back(p);
  }
  return all;
}

TEST(CorrectionLayer, ShowsTheBestSampleOfEveryPixelInAnyOrder) {
  std::mt19937 random(1);
  CorrectionLayer layer;
  for (const auto& [w, h, count] : {std::tuple{1, 1, 5},
                                    {3, 5, 40},
                                    {8, 8, 60},
                                    {17, 9, 300},
                                    {64, 48, 1500},
                                    {101, 37, 3000},
                                    {64, 48, 40}}) {
    const auto frame = maskFrame(w, h, blockId);
    std::vector<Placed> all = randomSamples(*frame, count, random);
    for (int shuffle = 0; shuffle < 3; ++shuffle) {
      layer.beginFrame(frame);
      for (const Placed& p : all) splat(layer, p);
      expectShows(layer, *frame, all);
      if (::testing::Test::HasFatalFailure()) return;
      std::shuffle(all.begin(), all.end(), random);
    }
  }
}

TEST(CorrectionLayer, PicturesTakenOnTheWayDoNotMatter) {
  std::mt19937 random(2);
  const auto frame = maskFrame(50, 40, blockId);
  const std::vector<Placed> all = randomSamples(*frame, 500, random);
  CorrectionLayer layer;
  layer.beginFrame(frame);
  for (const Placed& p : all) {
    splat(layer, p);
    if (random() % 50 == 0) layer.pixels();
  }
  expectShows(layer, *frame, all);
}

TEST(CorrectionLayer, EveryPixelTracedOnceConverges) {
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 5}, {150, 131}}) {
    const auto frame = maskFrame(w, h, [](int x, int y) { return (x - 3) * (y + 2) % 7 == 0 ? 0u : 1000u; });
    std::vector<Sample> samples = latticeSamples(*frame, core::Lattice::kMaxLevel);
    std::shuffle(samples.begin(), samples.end(), std::mt19937(3));
    CorrectionLayer layer;
    EXPECT_FALSE(layer.converged());
    layer.beginFrame(frame);
    for (const Sample& s : samples) {
      EXPECT_FALSE(layer.converged());
      layer.splat(s);
      layer.splat(s);
    }
    EXPECT_TRUE(layer.converged());
    EXPECT_EQ(layer.exactCount(), samples.size());
    const auto pixels = layer.pixels();
    for (const Sample& s : samples) {
      EXPECT_EQ(pixels[frame->index(s.x, s.y)], Vec4(s.correction, 0));
      EXPECT_TRUE(layer.isExact(s.x, s.y));
    }
  }
}

TEST(CorrectionLayer, OnePerturbedSampleShows) {
  const auto frame = maskFrame(30, 30, [](int, int) { return 2u; });
  CorrectionLayer layer;
  layer.beginFrame(frame);
  std::vector<Sample> samples = latticeSamples(*frame, core::Lattice::kMaxLevel);
  samples[417].correction.y += 1e-6f;
  for (const Sample& s : samples) layer.splat(s);
  const auto pixels = layer.pixels();
  int differ = 0;
  for (const Sample& s : latticeSamples(*frame, core::Lattice::kMaxLevel)) {
    differ += pixels[frame->index(s.x, s.y)] != Vec4(s.correction, 0);
  }
  EXPECT_EQ(differ, 1);
}

TEST(CorrectionLayer, NothingMovesAnExactPixel) {
  const auto frame = maskFrame(20, 20, [](int, int) { return 5u; });
  const Sample exact = sampleAt(*frame, 10, 10, 1);
  const Placed finer{sampleAt(*frame, 3, 3, 7), {10.5f, 10.5f}, 3, 1, true};
  for (const bool exactFirst : {false, true}) {
    CorrectionLayer layer;
    layer.beginFrame(frame);
    if (exactFirst) layer.splat(exact);
    splat(layer, finer);
    if (!exactFirst) layer.splat(exact);
    EXPECT_TRUE(layer.isExact(10, 10));
    EXPECT_EQ(layer.shownAt(10, 10)->level, 1);
    EXPECT_EQ(layer.shownAt(11, 10)->level, 7);
    EXPECT_EQ(layer.shownAt(11, 10)->ageFrames, 1);
    EXPECT_EQ(layer.shownAt(12, 10)->level, 1);
    EXPECT_FALSE(layer.isExact(12, 10));
    EXPECT_EQ(layer.exactCount(), 1u);
  }
}

TEST(CorrectionLayer, BeginFrameForgetsEverything) {
  CorrectionLayer layer;
  const auto first = maskFrame(33, 20, [](int x, int) { return x < 20 ? 1u : 0u; });
  const auto second = maskFrame(33, 20, [](int x, int) { return x < 20 ? 0u : 2u; });
  const auto third = maskFrame(9, 4, [](int, int) { return 2u; });
  for (const auto& frame : {first, second, third, first}) {
    layer.beginFrame(frame);
    EXPECT_EQ(layer.exactCount(), 0u);
    EXPECT_EQ(layer.coveredCount(), 0u);
    for (const Vec4& p : layer.pixels()) EXPECT_EQ(p, Vec4(0));
    ASSERT_EQ(layer.pixels().size(), frame->depth.size());
    std::vector<Placed> all;
    for (const Sample& s : latticeSamples(*frame, 6)) all.push_back({s});
    for (const Placed& p : all) splat(layer, p);
    expectShows(layer, *frame, all);
  }
}

TEST(CorrectionLayer, AFrameWithNothingToCorrectIsConverged) {
  CorrectionLayer layer;
  const auto frame = maskFrame(12, 7, [](int, int) { return 0u; });
  layer.beginFrame(frame);
  EXPECT_TRUE(layer.converged());
  layer.splat(sampleAt(*frame, 4, 4, 1));  // of id 0
  Sample other = sampleAt(*frame, 4, 4, 1);
  other.id = 9;
  layer.splat(other);
  EXPECT_EQ(layer.coveredCount(), 0u);
  EXPECT_EQ(layer.exactCount(), 0u);
}

TEST(CorrectionLayer, WarpedSplatsWithCentresOutsideReachIntoTheImage) {
  const auto frame = maskFrame(16, 16, [](int, int) { return 1u; });
  const Sample s = sampleAt(*frame, 0, 0, 3);
  CorrectionLayer layer;
  layer.beginFrame(frame);
  splat(layer, {s, {-3.5f, 18.5f}, 13, 1, true});  // centre (-4, 18), reaches x <= 2, y >= 12
  EXPECT_EQ(layer.coveredCount(), 3u * 4u);
  EXPECT_NE(layer.shownAt(2, 12), nullptr);
  EXPECT_EQ(layer.shownAt(3, 12), nullptr);
  for (const Vec2 away : {Vec2(-1e30f, 3), Vec2(3, 1e30f), Vec2(std::nanf(""), 2), Vec2(2, -INFINITY)}) {
    layer.beginFrame(frame);
    splat(layer, {s, away, 161, 1, true});
    EXPECT_EQ(layer.coveredCount(), 0u);
  }
}

// What is asked for in between changes no picture, and the list is what shownAt() says.
TEST(CorrectionLayer, ListsThePixelsThatShowNoSplat) {
  const auto frame = maskFrame(150, 93, [](int x, int y) { return x > 20 && y < 80 ? 1u + x / 50u : 0u; });
  std::mt19937 random(11);
  std::vector<Sample> samples = latticeSamples(*frame, 7);
  std::shuffle(samples.begin(), samples.end(), random);
  CorrectionLayer asked, plain;
  asked.beginFrame(frame), plain.beginFrame(frame);
  std::vector<core::Pixel> bare;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    asked.splat(samples[i]), plain.splat(samples[i]);
    if (i > 100 && i % 500 != 0 && i + 1 < samples.size()) continue;
    asked.listUncovered(bare);
    std::set<std::pair<int, int>> listed, truth;
    for (const auto& [x, y] : bare) listed.emplace(x, y);
    for (int y = 0; y < asked.height(); ++y) {
      for (int x = 0; x < asked.width(); ++x) {
        if (frame->idAt(x, y) != 0 && asked.shownAt(x, y) == nullptr) truth.emplace(x, y);
      }
    }
    ASSERT_EQ(listed, truth);
    ASSERT_EQ(bare.size(), listed.size());
  }
  EXPECT_TRUE(bare.empty());
  const auto a = asked.pixels(), b = plain.pixels();
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

}  // namespace
}  // namespace saccade::render
