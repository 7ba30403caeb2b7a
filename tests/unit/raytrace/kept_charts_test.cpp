// A light that changed: what it cannot have changed beyond the error target is kept, bit by bit.
#include "raytrace/bake/kept_charts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "raytrace/bake/texel_map.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;

/// Two closed rooms side by side, a lamp in each; and a point light in the first.
core::Scene twoRooms(float lampOfFirst, float lampOfSecond, Vec3 pointLight) {
  Builder b;
  b.room(0, 0.7f, lampOfFirst);
  b.room(2.2f, 2.9f, lampOfSecond);
  core::PunctualLight light;
  light.name = "bulb";
  light.position = Vec3(0.4f, 0.5f, 0.4f);
  light.intensity = pointLight;
  b.scene.lights.push_back(light);
  return std::move(b.scene);
}

BakeOptions quick() { return mediumBake(1 << 18); }

struct State {
  core::Scene scene;
  core::Plan plan;
  std::unique_ptr<World> world;
  core::IlluminationMaps maps;
  EarlierScene earlier;

  /// Charted anew.
  explicit State(core::Scene s) : scene(std::move(s)) {
    plan.lightmapSize = 128;
    ChartAtlas atlas = makeCharts(scene, plan, 128);
    core::applyCharts(scene, atlas.charts);
    world = std::make_unique<World>(scene, plan);
    maps = bakeMaps(*world, std::move(atlas.charts), atlas.size, quick(), {});
    earlier.state = core::sceneState(scene);
  }
  /// By the charts of earlier maps, not baked.
  State(core::Scene s, const core::IlluminationMaps& before) : scene(std::move(s)), maps(before) {
    plan.lightmapSize = 128;
    core::applyCharts(scene, before.charts);
    earlier.state = core::sceneState(scene);
    world = std::make_unique<World>(scene, plan);
  }
  core::IlluminationMaps bake(const KeptCharts* kept) const {
    BakeOptions o = quick();
    o.kept = kept;
    return bakeMaps(*world, maps.charts, maps.width, o, {});
  }
};

struct LightChange : SceneChange {
  std::vector<std::string> names;
};

/// Of states that differ in their lights only.
LightChange findChange(const State& now, const State& before) {
  const SceneMatch match = matchScenes(now.earlier.state, before.earlier.state);
  EXPECT_TRUE(match.sameObjects());
  const ChangedScene scene{now.scene, now.earlier.state, before.earlier.state, match};
  LightChange change;
  static_cast<SceneChange&>(change) =
      findSceneChange(scene, now.plan, before.maps, before.maps.width, {}, before.earlier.drift, 2, {});
  change.names = namesOfLights(scene);
  return change;
}

/// Calls visit(texel's x, y, lies in the first room).
template <class Visit>
void forEachTexel(const core::Scene& charted, int size, Visit&& visit) {
  const TexelMap texels(charted, size);
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0 || !(texels.area(t) > 0)) continue;
    const core::Object& object = charted.objects[texels.fragments(t).front().object];
    visit(static_cast<int>(t) % size, static_cast<int>(t) / size, object.bounds.hi.x < 2.1f);
  }
}

TEST(KeptCharts, ChangeInOneRoomLeavesTheOthersTexelsAndTheResultIsWithinTheTarget) {
  const State before(twoRooms(5, 5, Vec3(1)));
  const State now(twoRooms(5, 5, Vec3(3)), before.maps);
  const LightChange change = findChange(now, before);
  EXPECT_EQ(change.names, std::vector<std::string>{"bulb"});
  EXPECT_EQ(change.charts, 12u);
  EXPECT_EQ(change.keptCharts, 6u);
  EXPECT_NEAR(change.texelShare, 0.5, 0.05);
  EXPECT_EQ(change.drift, 0) << "walls are closed";
  const core::IlluminationMaps mixed = now.bake(&change.kept), whole = now.bake(nullptr);
  double squares = 0, sum = 0;
  int kept = 0, changed = 0, count = 0;
  forEachTexel(now.scene, mixed.width, [&](int x, int y, bool first) {
    const Vec3 e = mixed.texel(x, y, 0), was = before.maps.texel(x, y, 0), is = whole.texel(x, y, 0);
    if (first)
      changed += e != was;
    else
      kept += e == was;
    squares += std::pow(core::luminance(e) - core::luminance(is), 2);
    sum += core::luminance(is);
    ++count;
  });
  EXPECT_EQ(kept, count - static_cast<int>(std::lround(change.texelShare * count)));
  EXPECT_GT(changed, 0.99 * change.texelShare * count);
  EXPECT_LT(std::sqrt(squares / count) / (sum / count), qualityOf("medium").errorTarget);
}

TEST(KeptCharts, EmissionThatChangesIsNamedByItsObject) {
  const State before(twoRooms(5, 5, Vec3(0.1f)));
  const State now(twoRooms(5, 0, Vec3(0.1f)), before.maps);
  const LightChange change = findChange(now, before);
  EXPECT_EQ(change.names, std::vector<std::string>{now.scene.objects[13].name});
  EXPECT_EQ(change.keptCharts, 6u);
}

TEST(KeptCharts, OnlyLightThatChangesBakesEverythingAgain) {
  Builder b;
  b.room(0, 0.7f, 5);
  core::Scene brighter = b.scene;
  brighter.materials.back().emission *= 2.0f;
  const State before(std::move(b.scene));
  const State now(std::move(brighter), before.maps);
  const LightChange change = findChange(now, before);
  EXPECT_EQ(change.keptCharts, 0u);
  EXPECT_EQ(change.texelShare, 1);
}

TEST(KeptCharts, SmallChangesAddUpUntilTheyMatter) {
  // 0.4 % of the lamp's light: within the target once, not for ever.
  std::unique_ptr<State> state = std::make_unique<State>(twoRooms(5, 5, Vec3(0)));
  int stepsKept = 0;
  for (float lamp = 5.02f; stepsKept < 20; lamp += 0.02f, ++stepsKept) {
    auto next = std::make_unique<State>(twoRooms(lamp, 5, Vec3(0)), state->maps);
    const LightChange change = findChange(*next, *state);
    if (change.keptCharts < change.charts) break;
    next->earlier.drift = change.drift;
    state = std::move(next);
  }
  EXPECT_GT(stepsKept, 0);
  EXPECT_LT(stepsKept, 20);
}

}  // namespace
}  // namespace saccade::raytrace
