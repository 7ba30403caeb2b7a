#include "core/math/bilinear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/math/types.h"

namespace saccade::core {
namespace {

/// What bilinear interpolation gives back exactly: constant, x, y and x y. Powers of two, so without
/// rounding.
Vec3 form(float x, float y) { return {1 + x, 2 * y - x, x * y}; }

TEST(Bilinear, GivesBackBilinearFormsAlsoLeftOfZero) {
  const auto at = [](int x, int y) { return form(static_cast<float>(x), static_cast<float>(y)); };
  for (const float x : {-1.75f, -0.25f, 0.0f, 0.5f, 3.0f, 3.125f}) {
    for (const float y : {-2.0f, -0.5f, 0.75f, 2.0f}) {
      EXPECT_EQ(bilinear(x, y, at), form(x, y)) << x << ' ' << y;
      EXPECT_EQ(bilinear(double{x}, double{y}, at), form(x, y)) << x << ' ' << y;
    }
  }
}

TEST(Bilinear, AsksForTheFourAroundOnly) {
  std::vector<std::pair<int, int>> asked;
  bilinear(4.5f, -0.5f, [&](int x, int y) {
    asked.emplace_back(x, y);
    return 0.0f;
  });
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(asked, (std::vector<std::pair<int, int>>{{4, -1}, {4, 0}, {5, -1}, {5, 0}}));
}

}  // namespace
}  // namespace saccade::core
