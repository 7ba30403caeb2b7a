// Path tracing from every texel: unbiased, the same for any threads, and in parts as in one.
#include "raytrace/bake/path_gather.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;

/// A closed box of albedo one half whose walls shine: E = pi Le / (1 - albedo) everywhere.
class Furnace : public ::testing::Test {
 protected:
  Furnace() {
    SceneBuilder b;
    b.box(SceneBuilder::matte(0.5f, Vec3(1)), Vec3(0), Vec3(1), true);
    scene_ = std::move(b.scene);
    core::Plan plan;
    plan.lightmapSize = kSize;
    ChartAtlas atlas = makeCharts(scene_, plan, kSize);
    core::applyCharts(scene_, atlas.charts);
    size_ = atlas.size;
    world_ = std::make_unique<World>(scene_, plan);
    texels_ = std::make_unique<TexelMap>(scene_, size_);
  }
  std::vector<Vec3> gather(std::vector<Vec3> sums, std::uint64_t first, std::uint64_t paths, int threads,
                           int layer = 0) const {
    gatherPaths(*world_, *texels_, layer, {.firstPath = first, .paths = paths, .threads = threads}, {}, sums);
    return sums;
  }
  std::vector<Vec3> zeros() const { return std::vector<Vec3>(texels_->texelCount(), Vec3(0)); }

  static constexpr int kSize = 48;
  core::Scene scene_;
  int size_ = 0;
  std::unique_ptr<World> world_;
  std::unique_ptr<TexelMap> texels_;
};

TEST_F(Furnace, HasTheGeometricSeriesInItsMean) {
  constexpr std::uint64_t kPaths = 64;
  const std::vector<Vec3> sums = gather(zeros(), 0, kPaths, 2);
  double sum = 0, squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!(texels_->area(i) > 0)) {
      EXPECT_EQ(sums[i], Vec3(0));
      continue;
    }
    const double e = sums[i].x / static_cast<double>(kPaths);
    sum += e;
    squares += e * e;
    ++count;
  }
  const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
  ASSERT_LT(error, 0.005 * mean);
  EXPECT_NEAR(mean, 2 * core::kPi, 4 * error);
}

TEST_F(Furnace, GathersTheSamePathsInPartsAndOnAnyThreads) {
  const std::vector<Vec3> whole = gather(zeros(), 0, 6, 0);
  EXPECT_EQ(gather(zeros(), 0, 6, 3), whole);
  const std::vector<Vec3> parts = gather(gather(zeros(), 0, 2, 2), 2, 4, 2);
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_NEAR(parts[i].x, whole[i].x, 1e-5f * whole[i].x + 1e-6f);
}

TEST_F(Furnace, HasNoBacksWhereNothingIsDoubleSided) { EXPECT_EQ(gather(zeros(), 0, 1, 2, 1), zeros()); }

}  // namespace
}  // namespace saccade::raytrace
