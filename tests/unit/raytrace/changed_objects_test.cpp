// Objects that moved, came, went or changed their material: what they cannot have changed beyond the error
// target is kept, and the maps that come of it are within the target of a whole bake, chart by chart.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/scene_state.h"
#include "raytrace/bake/kept_charts.h"
#include "raytrace/bake/kept_layout.h"
#include "raytrace/bake/texel_map.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;

constexpr int kSize = 128;

struct Room {
  float boxX = 0.4f, boxAlbedo = 0.6f;  ///< of a box in the first room
  bool boxInSecond = false;
  bool lampMoved = false;  ///< that of the first room
  int rooms = 2;
};

/// Closed rooms side by side, a lamp in each.
core::Scene sceneOf(const Room& r) {
  Builder b;
  for (int i = 0; i < r.rooms; ++i) {
    const float x = 2.2f * static_cast<float>(i), lamp = x + (r.lampMoved && i == 0 ? 0.3f : 0.7f);
    b.room(x, lamp, 5);
  }
  const Vec3 size(0.4f, 0.5f, 0.4f);
  for (const float x : {r.boxX, 2.7f}) {
    if (x == 2.7f && !r.boxInSecond) continue;
    const Vec3 lo(x, 0.02f, 0.4f);
    b.box(Builder::matte(r.boxAlbedo), lo, lo + size, false);
  }
  return std::move(b.scene);
}

core::Plan planOf() {
  core::Plan plan;
  plan.lightmapSize = 2 * kSize;
  return plan;
}

BakeOptions quick() { return mediumBake(1 << 20); }

/// A scene with maps, baked whole.
struct Earlier {
  core::Scene scene;
  core::IlluminationMaps maps;
  core::SceneState state;

  explicit Earlier(core::Scene s) : scene(std::move(s)) {
    core::Plan plan = planOf();
    plan.lightmapSize = kSize;
    ChartAtlas atlas = makeCharts(scene, plan, kSize);
    core::applyCharts(scene, atlas.charts);
    const World world(scene, plan);
    maps = bakeMaps(world, std::move(atlas.charts), atlas.size, quick(), {});
    state = core::sceneState(scene);
  }
};

/// What is made of earlier maps for a scene that has changed.
struct Again {
  core::Scene scene;
  core::SceneState state;
  SceneMatch match;
  ChartAtlas fresh;
  KeptLayout layout;
  SceneChange change;
  core::IlluminationMaps mixed;

  Again(core::Scene s, const Earlier& earlier) : scene(std::move(s)), state(core::sceneState(scene)) {
    match = matchScenes(state, earlier.state);
    core::Plan plan = planOf();
    plan.lightmapSize = kSize;
    fresh = makeCharts(scene, plan, kSize);
    core::applyCharts(scene, fresh.charts);
    layout = keepLayout(scene, fresh, match, earlier.state.plain, earlier.maps, 2 * kSize).value();
    core::placeCharts(scene, layout.charts);
    change = findSceneChange({scene, state, earlier.state, match}, plan, earlier.maps, layout.size,
                             layout.inPlace, 0, 2, {});
    mixed = bake(&change.kept);
  }
  core::IlluminationMaps bake(const KeptCharts* kept) const {
    const World world(scene, planOf());
    BakeOptions o = quick();
    o.kept = kept;
    return bakeMaps(world, layout.charts, layout.size, o, {});
  }
  std::vector<std::string> names(const Earlier& earlier) const {
    return namesOfChanges(match, state, earlier.state);
  }
};

/// Largest root mean square difference within a chart, over its mean or that of all, whichever is more: two
/// whole bakes differ by noise, in proportion to a chart's light.
double worstChart(const Again& again, const core::IlluminationMaps& whole) {
  const TexelMap texels(again.scene, again.layout.size);
  std::vector<double> squares(texels.charts().size(), 0), sum = squares, count = squares;
  double light = 0, all = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0) continue;
    const int x = static_cast<int>(t) % texels.size(), y = static_cast<int>(t) / texels.size();
    const double wanted = core::luminance(whole.texel(x, y, 0)),
                 off = core::luminance(again.mixed.texel(x, y, 0)) - wanted;
    const auto c = static_cast<std::size_t>(texels.chartOf(t));
    squares[c] += off * off;
    sum[c] += wanted;
    ++count[c];
    light += wanted;
    ++all;
  }
  double worst = 0;
  for (std::size_t c = 0; c < count.size(); ++c) {
    if (count[c] == 0) continue;
    const double mean = std::max(light / all, sum[c] / count[c]);
    worst = std::max(worst, std::sqrt(squares[c] / count[c]) / mean);
  }
  return worst;
}

/// Texels of charts kept; each must be the earlier one, bit by bit.
std::size_t keptTexels(const Again& again, const Earlier& earlier) {
  const TexelMap texels(again.scene, again.layout.size);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0 || !again.change.kept.keep[static_cast<std::size_t>(texels.chartOf(t))])
      continue;
    const int x = static_cast<int>(t) % texels.size(), y = static_cast<int>(t) / texels.size();
    EXPECT_EQ(again.mixed.texel(x, y, 0), earlier.maps.texel(x, y, 0)) << x << ", " << y;
    ++kept;
  }
  return kept;
}

std::size_t texelsIn(const Again& again, float fromX, float toX) {
  const TexelMap texels(again.scene, again.layout.size);
  std::size_t n = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0) continue;
    const core::Bounds& b = again.scene.objects[texels.fragments(t).front().object].bounds;
    n += b.lo.x > fromX - 0.01f && b.hi.x < toX + 0.01f;
  }
  return n;
}

TEST(ChangedObjects, BoxThatMovesInOneOfTwoClosedRoomsLeavesTheOthersTexels) {
  const Earlier earlier(sceneOf({}));
  const Again again(sceneOf({.boxX = 1.0f}), earlier);
  EXPECT_EQ(again.names(earlier).size(), 6u);
  EXPECT_EQ(again.names(earlier).front(), "object 14 (moved)");
  EXPECT_EQ(again.change.charts, 18u);
  const std::size_t kept = keptTexels(again, earlier), second = texelsIn(again, 2.2f, 4.2f);
  EXPECT_GE(kept, second) << "nothing reaches the second room";
  EXPECT_LT(kept, second + texelsIn(again, 0, 2)) << "the floor under the box is another";
  const core::IlluminationMaps whole = again.bake(nullptr);
  EXPECT_LT(worstChart(again, whole), qualityOf("medium").errorTarget);
}

TEST(ChangedObjects, FaintBoxInOneRoomChangesWhatIsNearItOnly) {
  const Earlier earlier(sceneOf({.boxAlbedo = 0.50f, .rooms = 1}));
  const Again again(sceneOf({.boxAlbedo = 0.52f, .rooms = 1}), earlier);
  EXPECT_EQ(again.names(earlier).front(), "object 7 (material)");
  EXPECT_EQ(again.change.charts, 12u);
  EXPECT_EQ(again.change.keptCharts, 12u) << "4 % of what the box reflects is less than half the target";
  EXPECT_GT(again.change.drift, 0);
  EXPECT_EQ(again.change.texelShare, 0);
  EXPECT_LT(worstChart(again, again.bake(nullptr)), qualityOf("medium").errorTarget);
}

TEST(ChangedObjects, BlackBoxThatTurnsWhiteBakesWhatItLights) {
  const Earlier earlier(sceneOf({.boxAlbedo = 0.05f}));
  const Again again(sceneOf({.boxAlbedo = 0.95f}), earlier);
  EXPECT_GE(again.change.keptCharts, 6u);
  EXPECT_LT(again.change.keptCharts, 12u) << "walls beside it get what it reflects";
  EXPECT_GE(keptTexels(again, earlier), texelsIn(again, 2.2f, 4.2f));
  EXPECT_LT(worstChart(again, again.bake(nullptr)), qualityOf("medium").errorTarget);
}

/// Luminance alone would not tell: the walls beside the box get as much light as before, of another colour.
TEST(ChangedObjects, ColourOfTheSameBrightnessIsAChange) {
  constexpr Vec3 kRed(0.9f, 0.2f, 0.2f);
  const float green =
      (core::luminance(kRed) - core::luminance(Vec3(0.2f, 0, 0.2f))) / core::luminance({0, 1, 0});
  const auto painted = [](const Vec3& color) {
    core::Scene scene = sceneOf({.rooms = 1});
    for (core::Object& o : scene.objects) {
      core::Material& material = scene.materials[static_cast<std::size_t>(o.material)];
      if (o.bounds.hi.y < 0.6f && o.bounds.lo.y > 0.01f) material.baseColor = color;
    }
    return scene;
  };
  const Earlier earlier(painted(kRed));
  const Again again(painted({0.2f, green, 0.2f}), earlier);
  EXPECT_EQ(again.change.charts, 12u);
  EXPECT_LT(again.change.keptCharts, 12u);
}

TEST(ChangedObjects, BoxThatComesAndGoesBringsBackTheFirstMapsWhereItsRoomIs) {
  const Earlier without(sceneOf({}));
  const Again with(sceneOf({.boxInSecond = true}), without);
  EXPECT_EQ(with.names(without).front(), "object 20 (new)");
  EXPECT_EQ(with.change.charts, 24u);
  EXPECT_GE(keptTexels(with, without), texelsIn(with, 0, 2)) << "the first room is closed";
  EXPECT_LT(worstChart(with, with.bake(nullptr)), qualityOf("medium").errorTarget);

  Earlier then = without;
  then.scene = with.scene;
  then.maps = with.mixed;
  then.state = with.state;
  const Again gone(sceneOf({}), then);
  EXPECT_EQ(gone.names(then).front(), "object 20 (gone)");
  EXPECT_EQ(gone.layout.size, with.layout.size);
  EXPECT_GE(keptTexels(gone, then), texelsIn(gone, 0, 2));
  EXPECT_LT(worstChart(gone, gone.bake(nullptr)), qualityOf("medium").errorTarget);
}

TEST(ChangedObjects, LampThatMovesCountsInItsOldPlaceAndItsNew) {
  const Earlier earlier(sceneOf({}));
  const Again again(sceneOf({.lampMoved = true}), earlier);
  EXPECT_EQ(again.names(earlier).front(), "object 6 (moved)");
  EXPECT_EQ(again.change.keptCharts, 6u) << "all that shows irradiance in the second room";
  EXPECT_EQ(keptTexels(again, earlier), texelsIn(again, 2.2f, 4.2f));
  EXPECT_LT(worstChart(again, again.bake(nullptr)), qualityOf("medium").errorTarget);
}

TEST(ChangedObjects, SceneWithNothingLeftKeepsNoLayout) {
  const Earlier earlier(sceneOf({.rooms = 1}));
  Builder b;
  b.box(Builder::matte(0.5f), Vec3(0), Vec3(3), true);
  core::Scene other = std::move(b.scene);
  const SceneMatch match = matchScenes(core::sceneState(other), earlier.state);
  core::Plan plan = planOf();
  const ChartAtlas fresh = makeCharts(other, plan, kSize);
  core::applyCharts(other, fresh.charts);
  EXPECT_FALSE(keepLayout(other, fresh, match, earlier.state.plain, earlier.maps, kSize));
}

TEST(ChangedObjects, ChartsStayApartAndInsideTheAtlas) {
  const Earlier earlier(sceneOf({}));
  const Again again(sceneOf({.boxX = 1.0f, .boxInSecond = true}), earlier);
  const TexelMap texels(again.scene, again.layout.size);
  const auto rects = texels.charts();
  for (std::size_t a = 0; a < rects.size(); ++a) {
    EXPECT_LE(std::max(rects[a].x1, rects[a].y1), again.layout.size);
    for (std::size_t b = 0; b < a; ++b) {
      const int across = std::max(rects[a].x0 - rects[b].x1, rects[b].x0 - rects[a].x1),
                down = std::max(rects[a].y0 - rects[b].y1, rects[b].y0 - rects[a].y1);
      EXPECT_GE(std::max(across, down), 2) << a << ", " << b;
    }
  }
}

}  // namespace
}  // namespace saccade::raytrace
