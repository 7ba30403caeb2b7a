#include "raytrace/bake/quality.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace saccade::raytrace {
namespace {

TEST(Quality, EachIsBetterThanTheOneBefore) {
  const std::span<const Quality> all = qualities();
  ASSERT_EQ(all.size(), 3u);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Quality &less = all[i - 1], &more = all[i];
    EXPECT_LT(more.errorTarget, less.errorTarget);
    EXPECT_LE(more.texelError, less.texelError);
    EXPECT_GE(more.texels, less.texels);
    EXPECT_LE(more.coarsest, less.coarsest);
    EXPECT_GT(more.detailTexels, less.detailTexels);
    EXPECT_LT(more.detailError, less.detailError);
    EXPECT_GT(more.photons, less.photons);
    EXPECT_GT(more.directSamples, less.directSamples);
    EXPECT_GE(more.wholePoints, more.directSamples);
    EXPECT_GT(more.gatherRays, less.gatherRays);
  }
}

TEST(Quality, UnknownNamesAreRefusedWithThoseThatThereAre) {
  for (const Quality& q : qualities()) EXPECT_EQ(&qualityOf(q.name), &q);
  try {
    qualityOf("best");
    FAIL();
  } catch (const core::UsageError& e) {
    EXPECT_STREQ(e.what(), "unknown quality 'best': use one of preview, medium, high");
  }
}

}  // namespace
}  // namespace saccade::raytrace
