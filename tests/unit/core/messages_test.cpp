// Extents and start levels against counting pixel by pixel (Haber 2001, section 4.5; design fact 3).
#include "core/corrective/messages.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "tests/unit/core/mask_frame.h"

namespace saccade::core {
namespace {

using tests::frameOf;
using tests::randomMask;

ObjectExtent extentByBruteForce(const FrameSnapshot& frame, std::uint32_t id, std::uint32_t nMin) {
  ObjectExtent e;
  std::vector<std::uint32_t> points(Lattice::kMaxLevel + 1, 0);
  PixelBox box{1 << 30, 1 << 30, 0, 0};
  for (int y = 0; y < frame.view.height(); ++y) {
    for (int x = 0; x < frame.view.width(); ++x) {
      if (frame.idAt(x, y) != id) continue;
      ++e.pixels;
      box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), std::max(box.y1, y + 1)};
      for (int level = Lattice::levelOf(x, y); level <= Lattice::kMaxLevel; ++level) ++points[level];
    }
  }
  if (e.pixels > 0) e.box = box;
  e.startLevel = 1;
  while (e.startLevel < Lattice::kMaxLevel && (points[e.startLevel] < nMin || e.pixels == 0)) ++e.startLevel;
  return e;
}

TEST(MeasureExtents, EqualsCountingPixels) {
  struct Case {
    int width, height;
    std::uint32_t ids;
  };
  for (const Case& c : {Case{1, 1, 1}, Case{3, 5, 2}, Case{200, 150, 7}, Case{64, 64, 300}, Case{1, 200, 3},
                        Case{640, 400, 20}}) {
    for (int nMin : {1, 3, 10}) {
      const auto frame = frameOf(c.width, c.height, randomMask(c.width, c.height, c.ids, 5), c.ids, nMin);
      ASSERT_EQ(frame->extents.size(), c.ids + 1);
      std::uint32_t total = 0;
      for (std::uint32_t id = 1; id <= c.ids; ++id) {
        const ObjectExtent expected = extentByBruteForce(*frame, id, static_cast<std::uint32_t>(nMin));
        EXPECT_EQ(frame->extents[id].box, expected.box) << id;
        EXPECT_EQ(frame->extents[id].pixels, expected.pixels) << id;
        EXPECT_EQ(frame->extents[id].startLevel, expected.startLevel) << id;
        total += expected.pixels;
      }
      EXPECT_EQ(frame->nonDiffusePixels, total);
    }
  }
}

TEST(MeasureExtents, ADiscOfRadius30MayHaveNoPointOnLevelOne) {
  constexpr int kSize = 128;
  std::vector<std::uint32_t> ids(kSize * kSize, 0);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) ids[y * kSize + x] = (x - 60) * (x - 60) + (y - 60) * (y - 60) < 900;
  }
  const auto frame = frameOf(kSize, kSize, ids, 1);
  const ObjectExtent& e = frame->extents[1];
  EXPECT_EQ(e.box, (PixelBox{31, 31, 90, 90}));
  int onLevelOne = 0;
  walkLattice(e.box, beginLevel(e.box, 1), e.box.area(), false,
              [&](int x, int y) { onLevelOne += frame->idAt(x, y) == 1; });
  EXPECT_EQ(onLevelOne, 0);
  // 2,800 pixels: at least 10 points where 5^k < 280.
  EXPECT_EQ(e.startLevel, 4);
}

TEST(MeasureExtents, EmptyMaskAndObjectsOutOfSight) {
  const auto frame = frameOf(8, 4, std::vector<std::uint32_t>(32, 0), 3);
  EXPECT_EQ(frame->nonDiffusePixels, 0u);
  for (const ObjectExtent& e : frame->extents) {
    EXPECT_TRUE(e.box.empty());
    EXPECT_EQ(e.pixels, 0u);
  }
}

TEST(MeasureExtents, AnIdBeyondTheSceneIsRefused) { EXPECT_THROW(frameOf(2, 1, {1, 4}, 3), Error); }

TEST(ForEachPixel, VisitsTheMaskAlone) {
  const auto frame = frameOf(60, 40, randomMask(60, 40, 4, 9), 4);
  const PixelBox box = frame->extents[2].box;
  const Job job{frame, 2, beginLevel(box, Lattice::kMaxLevel), box.area(), false, 0, 1};
  std::uint32_t visits = 0;
  forEachPixel(job, [&](int x, int y) {
    EXPECT_EQ(frame->idAt(x, y), 2u);
    ++visits;
  });
  EXPECT_EQ(visits, frame->extents[2].pixels);
}

}  // namespace
}  // namespace saccade::core
