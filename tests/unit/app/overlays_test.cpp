// Overlays tell what the frame holds, and legends the colours that pictures have.
#include "app/session/overlays.h"

#include <set>

#include "app/viewer/legend_view.h"
#include "core/error.h"
#include "core/metrics/colormap.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::app {
namespace {

constexpr int kMaxAge = 30;

std::uint32_t packed(const core::Rgba8& c) { return c.r | c.g << 8 | c.b << 16; }

/// A walk of the Cornell box: cached samples of older cameras, then some for the last one.
class Overlays : public testing::Test {
 protected:
  static constexpr ImageSize kSize{160, 120};

  void walk(AgingTest aging, int frames = 4, std::uint64_t samples = 600) {
    const Workspace& workspace = tests::workspaceOf(tests::bundled("cornell.glb"));
    gl_.emplace(tests::runOn("osmesa"), workspace);
    CorrectiveOptions corrective;
    corrective.aging = aging;
    corrective.delta = 0.02f;
    loop_.emplace(workspace, *gl_->renderer, FrameLoopOptions{corrective, 0, 1, 0, false});
    core::Camera camera = workspace.scene.cameras[0];
    for (int i = 0; i < frames; ++i) {
      loop_->step(camera, kSize, FrameBudget::firstSamples(samples));
      if (i + 1 < frames) camera.eye.x += 0.01f * static_cast<float>(i + 1);
    }
  }
  const FrameLoop& loop() const { return *loop_; }
  const render::CorrectionLayer::Splat* shown(int x, int y) const { return loop().layer().shownAt(x, y); }

  template <class Check>
  void forEachPixel(const core::ImageGray& values, Check&& check) const {
    ASSERT_EQ(values.width(), kSize.width);
    ASSERT_EQ(values.height(), kSize.height);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) check(x, y, values.at(x, y));
    }
  }

  std::optional<Headless> gl_;
  std::optional<FrameLoop> loop_;
};

TEST_F(Overlays, IdsAreTheFramesAndSplatsTellTheirOwn) {
  walk(AgingTest::haber);
  forEachPixel(aovImage(Aov::id, loop()).values,
               [&](int x, int y, float v) { ASSERT_EQ(v, static_cast<float>(loop().frame().idAt(x, y))); });
  forEachPixel(aovImage(Aov::level, loop()).values,
               [&](int x, int y, float v) { ASSERT_EQ(v, shown(x, y) ? shown(x, y)->level : 0); });
  forEachPixel(aovImage(Aov::thread, loop()).values,
               [&](int x, int y, float v) { ASSERT_EQ(v, shown(x, y) ? shown(x, y)->thread + 1 : 0); });
  forEachPixel(aovImage(Aov::age, loop()).values,
               [&](int x, int y, float v) { ASSERT_EQ(v, shown(x, y) ? shown(x, y)->ageFrames : -1); });
}

TEST_F(Overlays, ImportanceIsTheAnalysersByObject) {
  walk(AgingTest::haber, 1);
  const auto analysis = loop().analyzer().latest();
  ASSERT_TRUE(analysis);
  bool some = false;
  forEachPixel(aovImage(Aov::importance, loop()).values, [&](int x, int y, float v) {
    const std::uint32_t id = loop().frame().idAt(x, y);
    ASSERT_EQ(v, id > 0 ? analysis->importance.priority[id] : 0);
    some |= v > 0;
  });
  EXPECT_TRUE(some);
}

TEST_F(Overlays, RanksAreTheQueuesByObject) {
  walk(AgingTest::haber, 1, 20);
  const std::vector<std::uint32_t> ranks = loop().ranks();
  float best = 0;
  forEachPixel(aovImage(Aov::rank, loop()).values, [&](int x, int y, float v) {
    const std::uint32_t id = loop().frame().idAt(x, y);
    ASSERT_EQ(v, id > 0 ? static_cast<float>(ranks[id]) : 0);
    if (v > 0 && (best == 0 || v < best)) best = v;
  });
  EXPECT_EQ(best, 1);
}

TEST_F(Overlays, AFirstFramesFootprintsAreTheLatticesSquares) {
  walk(AgingTest::haber, 1);
  std::set<float> sides;
  const AovImage image = aovImage(Aov::footprint, loop());
  forEachPixel(image.values, [&](int x, int y, float v) {
    if (!shown(x, y)) {
      ASSERT_EQ(v, 0);
      return;
    }
    ASSERT_EQ(v, static_cast<float>(core::Lattice::splatSide(shown(x, y)->level)));
    // The square around the sample's pixel holds every pixel that shows it.
    ASSERT_LE(2 * std::max(std::abs(x - shown(x, y)->x), std::abs(y - shown(x, y)->y)) + 1, v);
    sides.insert(v);
  });
  EXPECT_GE(sides.size(), 2u);
  // Between two splats there is an edge, within one there is none.
  for (int y = 0; y + 1 < kSize.height; ++y) {
    for (int x = 0; x + 1 < kSize.width; ++x) {
      const bool parts = shown(x, y) && (shown(x + 1, y) != shown(x, y) || shown(x, y + 1) != shown(x, y));
      ASSERT_EQ(image.edges[static_cast<std::size_t>(y * kSize.width + x)] != 0, parts);
    }
  }
}

TEST_F(Overlays, ValidityFollowsFromPixelAgeAndTheAgingTest) {
  for (const AgingTest aging : {AgingTest::haber, AgingTest::change}) {
    walk(aging);
    std::array<int, 5> counts{};
    forEachPixel(aovImage(Aov::validity, loop()).values, [&](int x, int y, float v) {
      const auto validity = static_cast<Validity>(static_cast<int>(v));
      ++counts[static_cast<std::size_t>(v)];
      ASSERT_EQ(validity == Validity::none, shown(x, y) == nullptr);
      if (!shown(x, y)) return;
      ASSERT_EQ(validity == Validity::exact, loop().layer().isExact(x, y));
      ASSERT_EQ(validity == Validity::valid || validity == Validity::stale, shown(x, y)->ageFrames > 0);
    });
    EXPECT_EQ(counts[1], static_cast<int>(loop().layer().exactCount()));
    EXPECT_GT(counts[2], 0);
    EXPECT_GT(counts[3], 0);
    if (aging == AgingTest::change) {
      EXPECT_EQ(counts[4], 0) << "each was tested by itself";
    }
  }
}

TEST_F(Overlays, WhatTheCacheKeepsByChangePassesTheTestSampleBySample) {
  walk(AgingTest::change);
  const core::Vec3 eye = loop().frame().view.camera().eye;
  std::size_t older = 0;
  float largest = 0;
  loop().cache().forEach([&](const core::Sample& s, std::uint64_t age) {
    if (age >= loop().frame().epoch) return;
    ++older;
    largest = std::max(largest, render::agedChange(AgingTest::change, s, eye));
  });
  EXPECT_GT(older, 100u);
  EXPECT_LE(largest, loop().settings().delta * (1 + 1e-4f));
  EXPECT_GT(largest, 0);
}

TEST_F(Overlays, EveryColourOfAPictureIsOneOfItsLegends) {
  walk(AgingTest::haber);
  for (std::size_t i = 0; i < aovNames().size(); ++i) {
    const auto aov = static_cast<Aov>(i);
    EXPECT_EQ(aovByName(aovNames()[i]), aov);
    AovImage image = aovImage(aov, loop());
    image.edges.clear();
    const AovScale scale(aov, image.values, kMaxAge);
    const AovLegend legend = aovLegend(scale, image.values, loop().tracer().world().scene());
    std::set<std::uint32_t> explained;
    if (legend.black[0] != '\0') explained.insert(packed({}));
    for (const AovLegend::Swatch& s : legend.swatches) {
      EXPECT_EQ(s.color, scale.color(s.value)) << aovNames()[i];
      EXPECT_FALSE(s.label.empty());
      EXPECT_NE(packed(s.color), packed({})) << "no category looks like none";
      explained.insert(packed(s.color));
    }
    EXPECT_EQ(legend.ramp.has_value(), legend.swatches.empty()) << aovNames()[i];
    const core::ImageRgba8 picture = aovPicture(image, scale);
    for (std::size_t p = 0; p < picture.pixels().size(); ++p) {
      const float value = image.values.pixels()[p];
      if (legend.ramp && value >= legend.ramp->leastValue) {
        EXPECT_LE(std::min(legend.ramp->low, legend.ramp->high), value) << aovNames()[i];
        EXPECT_GE(std::max(legend.ramp->low, legend.ramp->high), value) << aovNames()[i];
      } else {
        ASSERT_EQ(explained.count(packed(picture.pixels()[p])), 1u) << aovNames()[i] << " " << value;
      }
    }
  }
}

TEST(AovScale, RampsEndWhereTheirLabelsSay) {
  core::ImageGray values(1, 1, 1.5f);
  const AovScale importance(Aov::importance, values, kMaxAge);
  EXPECT_EQ(importance.ramp()->high, 1.5f);
  EXPECT_EQ(importance.ramp()->highLabel, "1.5");
  EXPECT_EQ(importance.color(1.5f), core::rampColor(1));
  EXPECT_EQ(importance.color(0), core::Rgba8{});
  const AovScale age(Aov::age, values, kMaxAge);
  EXPECT_EQ(age.color(0), core::rampColor(1));
  EXPECT_EQ(age.color(kMaxAge), age.color(kMaxAge + 5));
  EXPECT_NE(age.color(kMaxAge), core::Rgba8{});
  EXPECT_EQ(age.color(-1), core::Rgba8{});
  const AovScale footprint(Aov::footprint, values, kMaxAge);
  EXPECT_EQ(footprint.ramp()->lowLabel, "161 px");
  EXPECT_EQ(footprint.color(1), core::rampColor(1));
  std::set<std::uint32_t> colors;
  for (int level = 1; level <= core::Lattice::kMaxLevel; ++level)
    colors.insert(packed(footprint.color(static_cast<float>(core::Lattice::splatSide(level)))));
  EXPECT_EQ(colors.size(), 7u);
}

TEST(AovLegend, OfLevelsAndValidityNeverChanges) {
  const core::ImageGray none(4, 4);
  EXPECT_EQ(aovLegend(AovScale(Aov::validity, none, kMaxAge), none, {}).swatches.size(), 4u);
  EXPECT_EQ(aovLegend(AovScale(Aov::level, none, kMaxAge), none, {}).swatches.size(), 7u);
  EXPECT_TRUE(aovLegend(AovScale(Aov::thread, none, kMaxAge), none, {}).swatches.empty());
}

TEST(AovLegend, NamesTheLargestObjectsAndCountsTheRest) {
  core::Scene scene;
  constexpr int kObjects = 20;
  core::ImageGray values(100, 100);
  for (int id = 1; id <= kObjects; ++id) {
    core::Object object;
    object.name = "thing " + std::to_string(id);
    object.id = static_cast<std::uint32_t>(id);
    scene.objects.push_back(object);
    for (int n = 0; n < id; ++n) values.at(n, id) = static_cast<float>(id);  // object 20 is the largest
  }
  const AovLegend legend = aovLegend(AovScale(Aov::id, values, kMaxAge), values, scene);
  ASSERT_EQ(legend.swatches.size(), AovLegend::kMostSwatches);
  EXPECT_EQ(legend.leftOut, kObjects - AovLegend::kMostSwatches);
  EXPECT_EQ(legend.swatches.front().label, "9 thing 9");
  EXPECT_EQ(legend.swatches.back().label, "20 thing 20");
}

TEST(Overlay, StrengthMixesItWithThePicture) {
  const core::ImageRgba8 overlay(2, 1, {200, 0, 100, 255});
  core::ImageRgba8 picture(2, 1, {100, 50, 0, 255});
  layOver(overlay, 0, picture);
  EXPECT_EQ(picture.at(0, 0), (core::Rgba8{100, 50, 0, 255}));
  layOver(overlay, 0.5f, picture);
  EXPECT_EQ(picture.at(1, 0), (core::Rgba8{150, 25, 50, 255}));
  layOver(overlay, 1, picture);
  EXPECT_EQ(picture.at(0, 0), overlay.at(0, 0));
}

TEST(AovByName, UnknownOnesAreToldTheNames) {
  try {
    aovByName("depth");
    FAIL();
  } catch (const core::UsageError& e) {
    EXPECT_NE(std::string(e.what()).find(aovList()), std::string::npos);
  }
}

}  // namespace
}  // namespace saccade::app
