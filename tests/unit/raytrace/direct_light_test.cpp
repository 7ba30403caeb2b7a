// Direct light of every texel against closed forms, before any smoothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytrace/bake/direct.h"
#include "raytrace/bake/receiver.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/bake_scenes.h"
#include "tests/unit/raytrace/irradiance.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;
using Builder = SceneBuilder;

constexpr int kHigh = 64;  // samples, as --quality high has

/// The direct light of a charted scene's fronts.
class Direct {
 public:
  Direct(core::Scene scene, int size) : scene_(std::move(scene)) {
    plan_.lightmapSize = size;
    const ChartAtlas atlas = makeCharts(scene_, plan_, size);
    core::applyCharts(scene_, atlas.charts);
    world_ = std::make_unique<World>(scene_, plan_);
    texels_ = std::make_unique<TexelMap>(scene_, atlas.size);
    open_ = std::make_unique<OpenArea>(*texels_, 1);
    open_->probe(*world_, *texels_, 0, allBlocks(texels_->texelCount()), 2, {});
  }
  std::vector<DirectEstimate> bake(int samples, std::uint32_t seed = 1, int refinement = 4) const {
    DirectOptions options;
    options.samples = samples;
    options.seed = seed;
    options.refinement = refinement;
    options.relativeError = 0.005f;
    options.threads = 2;
    std::vector<DirectEstimate> out(texels_->texelCount());
    directIrradiance(*world_, *texels_, *open_, 0, allBlocks(texels_->texelCount()), options, {}, out);
    return out;
  }
  /// Mean of truth(point, normal) over a texel.
  template <class Truth>
  double over(std::size_t texel, Truth&& truth, int n) const {
    double sum = 0;
    float below = 0;
    for (const TexelFragment& part : texels_->fragments(texel)) {
      const float u = (below + 0.5f * part.area) / texels_->area(texel);
      below += part.area;
      for (int i = 0; i < n * n; ++i) {
        const float v = (static_cast<float>(i % n) + 0.5f) / static_cast<float>(n),
                    w = (static_cast<float>(i / n) + 0.5f) / static_cast<float>(n);
        const Receiver at(*world_, texels_->pointOn(texel, u, v, w), true);
        sum += truth(at.surface.position, at.normal) * part.area / (n * n * texels_->area(texel));
      }
    }
    return sum;
  }
  /// Texels that show this object.
  std::vector<std::size_t> texelsOf(int object) const {
    std::vector<std::size_t> out;
    for (std::size_t t = 0; t < texels_->texelCount(); ++t) {
      if (texels_->chartOf(t) >= 0 && texels_->area(t) > 0 &&
          texels_->fragments(t).front().object == static_cast<std::uint32_t>(object))
        out.push_back(t);
    }
    return out;
  }
  double openShare(std::size_t texel) const { return open_->areas(0)[texel] / texels_->area(texel); }
  /// RMS difference of an object's texels to truth(point, normal), as a share of its mean.
  template <class Truth>
  double error(int object, Truth&& truth, int n = 8) const {
    const std::vector<DirectEstimate> found = bake(kHigh);
    double squares = 0, mean = 0;
    const std::vector<std::size_t> of = texelsOf(object);
    EXPECT_GT(of.size(), 100u);
    for (const std::size_t t : of) {
      const double e = over(t, truth, n);
      squares += std::pow(core::luminance(found[t].irradiance) - e, 2) / static_cast<double>(of.size());
      mean += e / static_cast<double>(of.size());
    }
    return std::sqrt(squares) / mean;
  }
  const World& world() const { return *world_; }

 private:
  core::Scene scene_;
  core::Plan plan_;
  std::unique_ptr<World> world_;
  std::unique_ptr<TexelMap> texels_;
  std::unique_ptr<OpenArea> open_;
};

/// A rectangle's irradiance by Lambert's formula in double.
auto rectangle(const Vec3& corner, const Vec3& u, const Vec3& v, double radiance) {
  return [=](const Vec3& point, const Vec3& normal) {
    return radiance * polygonIrradiance(point, normal, {corner, corner + u, corner + u + v, corner + v});
  };
}

/// RMS error of a plane of 2 m x 2 m in y = 0 under a rectangle that lights what u x v points to.
double errorUnder(const Vec3& corner, const Vec3& u, const Vec3& v) {
  Builder b;
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  b.quad(Builder::matte(0, Vec3(3)), corner, u, v);
  return Direct(std::move(b.scene), 64).error(floor, rectangle(corner, u, v, 3));
}

TEST(DirectLight, Hard8RectangleAboveCutByTheHorizonAndBeside) {
  HardCase error("direct light of a rectangle, RMS over texels of their mean");
  EXPECT_TRUE(error.within(errorUnder(Vec3(-0.5f, 0.5f, -0.3f), Vec3(1, 0, 0), Vec3(0, 0, 0.6f)), 0.001));
  // Upright through the floor: half of it is below the horizon.
  EXPECT_TRUE(error.within(errorUnder(Vec3(-0.4f, -0.5f, -1.1f), Vec3(0.8f, 0, 0), Vec3(0, 1, 0)), 0.005));
  // Perpendicular plates with a shared edge.
  EXPECT_TRUE(error.within(errorUnder(Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0)), 0.005));
}

TEST(DirectLight, Hard8ParallelPlatesAHundredthOfTheirSideApart) {
  const Vec3 corner(-1, 0.02f, -1), u(2, 0, 0), v(0, 0, 2);
  EXPECT_TRUE(HardCase("direct light of a plate at 1/100 of its side, RMS over texels of their mean")
                  .within(errorUnder(corner, u, v), 0.005));
}

TEST(DirectLight, Hard8DiskOnItsAxisAndALampOneCentimetreBelowItsCeiling) {
  Builder b;
  const float r = 0.4f, h = 0.7f;
  const int spot =
      b.quad(Builder::matte(0.5f), Vec3(-0.01f, 0, 0.01f), Vec3(0.02f, 0, 0), Vec3(0, 0, -0.02f));
  b.disk(Builder::matte(0, Vec3(3)), Vec3(0, h, 0), r, 32);
  const double disk = Direct(std::move(b.scene), 32).error(spot, [&](const Vec3& p, const Vec3&) {
    const double away = double{p.x} * p.x + double{p.z} * p.z, k = double{r} * r + double{h} * h;
    // Off the axis to second order.
    return core::kPi * 3 * r * r / k * (1 - 2 * away * h * h / (k * k));
  });
  EXPECT_TRUE(HardCase("direct light of a disk, RMS over texels of their mean").within(disk, 0.001));

  Builder room;  // both sides of the lamp shine
  core::Material glow = Builder::matte(0, Vec3(3));
  glow.doubleSided = true;
  const int ceiling = room.quad(Builder::matte(0.5f), Vec3(-1, 2, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
  const Vec3 corner(-0.25f, 1.99f, -0.2f), u(0.5f, 0, 0), v(0, 0, 0.4f);
  room.quad(glow, corner, u, v);
  // The lamp's outline parts light from dark within a texel: its mean takes many points.
  const double gap = Direct(std::move(room.scene), 64).error(ceiling, rectangle(corner, u, v, 3), 32);
  EXPECT_TRUE(HardCase("direct light 1 cm from a lamp, RMS over texels of their mean").within(gap, 0.005));
}

TEST(DirectLight, Hard8LightAtGrazingAngleOrBehindIsZero) {
  Builder b;
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  b.quad(Builder::matte(0, Vec3(3)), Vec3(1, 0, -1), Vec3(1, 0, 0), Vec3(0, 0, 1));       // in its plane
  b.quad(Builder::matte(0, Vec3(3)), Vec3(-1, 0.5f, -1), Vec3(0, 0, 2), Vec3(2, 0, 0));   // shines upwards
  b.quad(Builder::matte(0, Vec3(3)), Vec3(-1, -0.5f, -1), Vec3(0, 0, 2), Vec3(2, 0, 0));  // from below
  const Direct direct(std::move(b.scene), 32);
  const std::vector<DirectEstimate> found = direct.bake(4);
  for (const std::size_t t : direct.texelsOf(floor)) ASSERT_EQ(found[t].irradiance, Vec3(0));
}

TEST(DirectLight, WhatLiesUnderABodyDoesNotDarkenTheTexelsThatItCuts) {
  Builder b;  // under a sun overhead all that is open is lit alike
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  const auto leg = [](float s, float t) {  // round, so that it cuts texels at any share; 2 mm above the floor
    const float a = 2 * core::kPi * s, y = 0.002f + std::clamp(1.5f * t - 0.25f, 0.0f, 1.0f),
                r = 0.3f * std::clamp(std::min(t, 1 - t) * 6, 0.0f, 1.0f);
    return Vec3(r * std::cos(a), y, -r * std::sin(a));
  };
  b.patch(Builder::matte(0.5f), 48, 12, leg);
  core::PunctualLight sun;
  sun.type = core::PunctualLight::Type::directional;
  sun.direction = Vec3(0, -1, 0);
  sun.intensity = Vec3(4);
  b.scene.lights.push_back(sun);
  const Direct direct(std::move(b.scene), 96);
  const std::vector<DirectEstimate> found = direct.bake(16);
  int cut = 0, covered = 0;
  for (const std::size_t t : direct.texelsOf(floor)) {
    if (direct.openShare(t) == 0) {
      ++covered;
      continue;
    }
    cut += direct.openShare(t) < 1;
    ASSERT_NEAR(found[t].irradiance.y, 4, 0.02) << direct.openShare(t);
  }
  EXPECT_GT(cut, 20);
  EXPECT_GT(covered, 20);
}

TEST(DirectLight, StatedVarianceBoundsTheSpreadOfManySeedsAndIsZeroInTheOpen) {
  Builder b;  // a post throws a penumbra; colours tell two lamps apart
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  b.box(Builder::matte(0.5f), Vec3(-0.1f, 0.1f, -0.1f), Vec3(0.1f, 0.4f, 0.1f), false);
  b.quad(Builder::matte(0, Vec3(9, 1, 1)), Vec3(-0.6f, 1, -0.2f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  b.quad(Builder::matte(0, Vec3(1, 1, 9)), Vec3(0.5f, 0.8f, -0.2f), Vec3(0.3f, 0, 0), Vec3(0, 0, 0.4f));
  const Direct direct(std::move(b.scene), 48);
  const std::vector<std::size_t> texels = direct.texelsOf(floor);
  constexpr int kSeeds = 24;
  std::vector<std::vector<DirectEstimate>> runs;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) runs.push_back(direct.bake(16, seed, 1));
  double stated = 0, found = 0, open = 0, mean = 0;
  int quiet = 0;
  for (const std::size_t t : texels) {
    double sum = 0, squares = 0, variance = 0;
    for (const auto& run : runs) {
      const double y = core::luminance(run[t].irradiance);
      sum += y;
      squares += y * y;
      variance += run[t].variance / kSeeds;
    }
    const double spread = (squares - sum * sum / kSeeds) / (kSeeds - 1);
    stated += variance;
    found += spread;
    mean += sum / kSeeds / static_cast<double>(texels.size());
    if (variance > 1e-5 * sum / kSeeds * sum / kSeeds) continue;
    ++quiet;
    open = std::max(open, std::sqrt(spread) / (sum / kSeeds));
  }
  EXPECT_GT(quiet, static_cast<int>(texels.size()) / 4);
  EXPECT_LT(open, 0.005);
  EXPECT_GT(found, 0);
  // Samples lie evenly, so that their spread says too much: a bound, and no empty one.
  EXPECT_GT(found / stated, 0.25);
  EXPECT_LT(found / stated, 1);
}

TEST(DirectLight, ManyLampsAndFewAgree) {
  // The same light as one panel, and as a panel of more pieces than are taken one by one.
  const auto panel = [](int pieces) {
    Builder b;
    b.quad(Builder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
    b.quad(Builder::matte(0.5f), Vec3(-0.3f, 0.3f, 0.3f), Vec3(0.6f, 0, 0), Vec3(0, 0, -0.6f));
    b.patch(Builder::matte(0, Vec3(3)), pieces, pieces,
            [](float s, float t) { return Vec3(-0.4f + 0.8f * s, 1, -0.4f + 0.8f * t); });
    return Direct(std::move(b.scene), 48);
  };
  const Direct few = panel(1), many = panel(8);
  const std::vector<DirectEstimate> a = few.bake(kHigh), b = many.bake(kHigh);
  const std::vector<std::size_t> ofFew = few.texelsOf(0), ofMany = many.texelsOf(0);
  ASSERT_EQ(ofFew, ofMany);
  double sum = 0, other = 0, squares = 0, stated = 0;
  for (const std::size_t t : ofFew) {
    sum += a[t].irradiance.x;
    other += b[t].irradiance.x;
    squares += std::pow(a[t].irradiance.x - b[t].irradiance.x, 2);
    stated += a[t].variance + b[t].variance;
  }
  EXPECT_NEAR(other / sum, 1, 0.002);
  EXPECT_LT(squares / stated, 1.5);
}

}  // namespace
}  // namespace saccade::raytrace
