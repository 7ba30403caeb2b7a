// Charts and trees report how far they are, and end early where nobody wants them any more.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "core/error.h"
#include "core/scene/load.h"
#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/light_charts.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

/// A bumpy sheet: `side` squared squares.
core::Scene sheet(int side) {
  core::Scene scene;
  scene.materials.emplace_back().metallic = 0;
  core::Mesh mesh;
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      mesh.positions.push_back(core::Vec3(x, (x * 7 + y * 5) % 3, y) * (4.0f / static_cast<float>(side)));
      mesh.normals.push_back(core::Vec3(0, 1, 0));
    }
  }
  const auto vertex = [&](int x, int y) { return static_cast<std::uint32_t>(y * (side + 1) + x); };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      for (const std::uint32_t v : {vertex(x, y), vertex(x, y + 1), vertex(x + 1, y), vertex(x + 1, y),
                                    vertex(x, y + 1), vertex(x + 1, y + 1)})
        mesh.indices.push_back(v);
    }
  }
  core::Object object;
  object.name = "sheet";
  scene.add(std::move(object), std::move(mesh));
  core::completeScene(scene, {});
  return scene;
}

/// Fractions that a Progress was told, none after the one at which it asked for a stop.
struct Told {
  std::stop_source stop;
  double stopAt = 2;
  std::vector<double> fractions;

  core::Progress progress() {
    return {[this](double f) {
              EXPECT_FALSE(stop.stop_requested());
              EXPECT_GE(f, fractions.empty() ? 0 : fractions.back());
              EXPECT_LE(f, 1);
              fractions.push_back(f);
              if (f >= stopAt) stop.request_stop();
            },
            stop.get_token()};
  }
};

void expectStopped(const std::function<void()>& work) {
  try {
    work();
    FAIL() << "it went on to its end";
  } catch (const core::Error& e) {
    EXPECT_STREQ(e.what(), "stopped on request");
  }
}

TEST(Stopping, TheTreeIsNotBuiltToItsEnd) {
  const core::Scene scene = sheet(300);
  const core::Plan plan = core::makePlan(scene);
  Told told;
  told.stopAt = 0;  // the first report comes from within Embree's build
  expectStopped([&] { World(scene, plan, told.progress()); });
  EXPECT_EQ(told.fractions.size(), 1u);
  Told whole;
  const World world(scene, plan, whole.progress());
  EXPECT_FALSE(whole.fractions.empty());
}

TEST(Stopping, ALayoutOfChartsEndsBetweenTwoObjects) {
  core::Scene scene = sheet(20);
  for (int i = 0; i < 9; ++i) {
    core::Object object = scene.objects[0];
    scene.add(std::move(object), core::Mesh(scene.meshes[0]));
  }
  Told told;
  told.stopAt = 0.5;
  expectStopped([&] { ChartLayout(scene, 1 << 20, VertexLight::never, 0, told.progress()); });
  EXPECT_EQ(told.fractions.size(), 5u);
  Told whole;
  EXPECT_GT(ChartLayout(scene, 1 << 20, VertexLight::never, 0, whole.progress()).chartCount(), 0u);
  EXPECT_EQ(whole.fractions.size(), 10u);
}

TEST(Stopping, ChartsOfOneMeshAreNotCutToTheirEnd) {
  const core::Scene scene = sheet(20);
  std::stop_source stop;
  stop.request_stop();
  expectStopped([&] { clusterMesh(scene.meshes[0], stop.get_token()); });
}

// All of it, up to the measuring of light: each part's share follows the one before.
TEST(Stopping, ChartingReportsAllOfItsParts) {
  core::Scene scene = sheet(100);
  const core::Plan plan = core::makePlan(scene);
  Told told;
  chartByLight(scene, plan, {.quality = "preview"}, told.progress());
  ASSERT_FALSE(told.fractions.empty());
  EXPECT_LT(told.fractions.front(), 0.5);
  EXPECT_EQ(told.fractions.back(), 1);
}

}  // namespace
}  // namespace saccade::raytrace
