// The two methods of walking the lattice, and the holes that the paper's splat size leaves.
#include <gtest/gtest.h>

#include "bench/paper/lattice.h"

namespace saccade::bench {
namespace {

TEST(PaperLattice, BothMethodsVisitEveryPixelOnce) {
  for (const core::PixelBox& box :
       {core::PixelBox{0, 0, 64, 64}, core::PixelBox{3, 5, 260, 131}, core::PixelBox{0, 0, 1, 1}}) {
    const LatticeTally tally = latticeIterative(box);
    EXPECT_EQ(tally.points, static_cast<std::uint64_t>(box.area()));
    EXPECT_EQ(tally, latticeRecursive(box));
  }
}

TEST(PaperLattice, ThePapersSideLeavesHolesOurSideNone) {
  // Level 6 of the paper has the even side 2.
  EXPECT_EQ(papersSplatSide(6), 2);
  EXPECT_EQ(papersSplatSide(7), 1);
  EXPECT_EQ(barePixels(150, 1, papersSplatSide), 2728);
  EXPECT_EQ(barePixels(150, 6, papersSplatSide), 1);
  EXPECT_EQ(barePixels(150, 7, papersSplatSide), 0);
  for (int last = 1; last <= core::Lattice::kMaxLevel; ++last)
    EXPECT_EQ(barePixels(150, last, core::Lattice::splatSide), 0);
}

}  // namespace
}  // namespace saccade::bench
