// What the model's speed is measured against computes the same maps.
#include "attention/plain_saliency.h"

#include <gtest/gtest.h>

#include <cmath>

#include "attention/saliency.h"
#include "core/error.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

double correlation(const core::ImageGray& a, const core::ImageGray& b) {
  double sumA = 0, sumB = 0, aa = 0, bb = 0, ab = 0;
  const auto n = static_cast<double>(a.pixels().size());
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    const double u = a.pixels()[i], v = b.pixels()[i];
    sumA += u, sumB += v, aa += u * u, bb += v * v, ab += u * v;
  }
  return (ab / n - sumA / n * (sumB / n)) /
         std::sqrt((aa / n - sumA * sumA / (n * n)) * (bb / n - sumB * sumB / (n * n)));
}

// Not equal: pyrDown moves level 4 by 7.5 pixels and the coarsest by 127.5 towards the corner, which ours
// does not; another picture's map correlates with neither.
TEST(PlainSaliency, IsTheSameMapUpToThePyramidsShift) {
  double least = 1;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    for (const auto& [width, height] : {std::pair{512, 512}, {800, 600}}) {
      const core::ImageRgba8 image = tests::randomDiscs(width, height, 12, seed);
      const core::ImageRgba8 other = tests::randomDiscs(width, height, 12, seed + 100);
      const core::ImageGray plain = plainSaliency(image), ours = saliencyOf(image, {});
      const double same = correlation(plain, ours);
      least = std::min(least, same);
      EXPECT_GT(same, 0.9) << width << " x " << height << ", seed " << seed;
      EXPECT_LT(correlation(plain, saliencyOf(other, {})), 0.6);
    }
  }
  RecordProperty("least_correlation", std::to_string(least));
}

TEST(PlainSaliency, SmallImagesAreRefused) {
  EXPECT_THROW(plainSaliency(core::ImageRgba8(255, 300)), core::Error);
  EXPECT_EQ(plainSaliency(core::ImageRgba8(256, 300)).height(), 300);
}

}  // namespace
}  // namespace saccade::attention
