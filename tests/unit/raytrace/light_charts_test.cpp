// Texels where light varies: structure functions against analytic ones, the choice of densities against its
// optimality condition, the atlas within its cap.
#include "raytrace/bake/light_charts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bake_scenes.h"
#include "raytrace/bake/chart_layout.h"
#include "raytrace/bake/light_variation.h"
#include "raytrace/bake/texel_density.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;

core::PunctualLight pointLight(Vec3 position, float intensity) {
  core::PunctualLight light;
  light.position = position;
  light.intensity = Vec3(intensity);
  return light;
}

void floorOf(SceneBuilder& b, float side) {
  b.quad(SceneBuilder::matte(0.5f), Vec3(-side / 2, 0, side / 2), Vec3(side, 0, 0), Vec3(0, 0, -side));
}

core::Plan planOf(int size) {
  core::Plan plan;
  plan.lightmapSize = size;
  plan.coarsestTexel = 0.2f;
  plan.finestTexel = 1e-4f;
  return plan;
}

/// Charted evenly, and what its first item's light does.
LightVariation variationOf(core::Scene scene, const VariationOptions& options) {
  ChartLayout layout(scene);
  const std::vector<double> texels(layout.items().size(), 0.02);
  EXPECT_TRUE(layout.pack(texels, 256));
  core::applyCharts(scene, layout.cut(256));
  const World world(scene, {});
  return measureVariation(world, TexelMap(scene, 256), layout, options, {}).at(0);
}

/// E under a point light of 1 W/sr at height `h`.
double underPointLight(double x, double z, double h) { return h / std::pow(x * x + z * z + h * h, 1.5); }

TEST(LightVariation, OfSmoothLightIsTheSecondDifference) {
  SceneBuilder b;
  floorOf(b, 2);
  b.scene.lights.push_back(pointLight(Vec3(0, 0.5f, 0), 1));
  VariationOptions options;
  options.metres = {0.1, 0.05, 0.02};
  const LightVariation v = variationOf(b.scene, options);
  EXPECT_NEAR(v.area, 4, 1e-5);
  for (std::size_t d = 0; d < options.metres.size(); ++d) {
    // The mean over all places and directions that have room, by quadrature.
    double sum = 0, count = 0;
    const double m = options.metres[d];
    for (int i = 0; i < 200; ++i) {
      for (int j = 0; j < 200; ++j) {
        for (int k = 0; k < 12; ++k) {
          const double x = (i + 0.5) / 100 - 1, z = (j + 0.5) / 100 - 1, a = core::kPi * (k + 0.5) / 12;
          const double dx = m * std::cos(a), dz = m * std::sin(a);
          if (std::abs(x) + std::abs(dx) > 1 || std::abs(z) + std::abs(dz) > 1) continue;
          const double second = underPointLight(x - dx, z - dz, 0.5) - 2 * underPointLight(x, z, 0.5) +
                                underPointLight(x + dx, z + dz, 0.5);
          sum += second * second;
          ++count;
        }
      }
    }
    EXPECT_NEAR(v.structure[d], sum / count, 0.03 * sum / count) << m;
  }
}

TEST(LightVariation, OfAStepIsProportionalToDistance) {
  SceneBuilder b;
  floorOf(b, 2);
  // A light from straight above, half of the floor behind a shade.
  core::PunctualLight sun;
  sun.type = core::PunctualLight::Type::directional;
  sun.intensity = Vec3(3);
  b.scene.lights.push_back(sun);
  b.quad(SceneBuilder::matte(0), Vec3(0, 1, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  VariationOptions options;
  options.metres = {0.08, 0.04, 0.02};
  options.points = 200000;
  const LightVariation v = variationOf(b.scene, options);
  EXPECT_NEAR(v.irradiance, 1.5, 0.02);
  for (std::size_t d = 0; d < options.metres.size(); ++d) {
    // A step of 3 W/m^2 over 2 m of 4 m^2: met by either half of the pair of differences.
    const double expected = 9 * 2 / 4.0 * (2 / core::kPi) * 2 * options.metres[d];
    EXPECT_NEAR(v.structure[d], expected, 0.08 * expected);
  }
}

TEST(LightVariation, NoiseOfLightSamplesDoesNotCount) {
  SceneBuilder b;
  floorOf(b, 2);
  // A lamp close above all of it: even light in the middle, from many places at once.
  b.quad(SceneBuilder::matte(0, Vec3(10)), Vec3(-50, 0.05f, -50), Vec3(100, 0, 0), Vec3(0, 0, 100));
  VariationOptions options;
  options.metres = {0.1, 0.05, 0.02};
  const LightVariation v = variationOf(b.scene, options);
  const double even = 10 * core::kPi;
  EXPECT_NEAR(v.irradiance, even, 0.02 * even);
  for (const double s : v.structure) EXPECT_LT(s, 1e-3 * even * even);
}

TEST(TexelDensity, SlopesOfErrorByTexelsAreEqual) {
  SceneBuilder b;
  for (int i = 0; i < 3; ++i) {
    b.quad(SceneBuilder::matte(0.5f), Vec3(0, static_cast<float>(i), 0), Vec3(2, 0, 0), Vec3(0, 0, 1));
  }
  ChartLayout layout(b.scene);
  const std::vector<double> metres = {0.08, 0.02, 0.005};
  const double power[3] = {1, 1, 2.5}, factor[3] = {1, 1.0 / 8, 40};
  std::vector<LightVariation> variation(3);
  for (std::size_t i = 0; i < 3; ++i) {
    variation[i].area = 2;
    variation[i].irradiance = 1;
    for (std::size_t d = 0; d < 3; ++d) variation[i].structure[d] = factor[i] * std::pow(metres[d], power[i]);
  }
  DensityGoal goal;
  goal.finest = 1e-5;
  goal.relativeError = 0.02;
  goal.mostTexels = 1e9;
  const DensityChoice wanted = chooseDensity(layout, variation, metres, goal);
  EXPECT_NEAR(wanted.relativeError, 0.02, 1e-5);
  EXPECT_NEAR(wanted.texelMetres[1] / wanted.texelMetres[0], 2, 1e-6);  // the third root of 8
  const auto slope = [&](std::size_t i) {                               // d(k h^p) / d(1 / h^2)
    return factor[i] * power[i] * std::pow(wanted.texelMetres[i], power[i] + 2);
  };
  EXPECT_NEAR(slope(2) / slope(0), 1, 1e-6);

  goal.mostTexels = 0.25 * layout.texelCount(wanted.texelMetres);
  const DensityChoice capped = chooseDensity(layout, variation, metres, goal);
  EXPECT_LE(layout.texelCount(capped.texelMetres), goal.mostTexels);
  EXPECT_GT(layout.texelCount(capped.texelMetres), 0.9 * goal.mostTexels);
  EXPECT_GT(capped.relativeError, 0.02);
}

/// A dark floor below a wall that a lamp beside it lights sharply.
core::Scene sharplyLitWall() {
  SceneBuilder b;
  floorOf(b, 2);
  b.quad(SceneBuilder::matte(0.5f), Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0));
  b.scene.lights.push_back(pointLight(Vec3(0, 1.5f, -0.95f), 0.1f));
  b.quad(SceneBuilder::matte(0.5f), Vec3(-1, 0.3f, 1), Vec3(2, 0, 0), Vec3(0, 0, -1.9f));  // over the floor
  return b.scene;
}

TEST(LightCharts, TexelsGoWhereLightVariesAndStayWithinTheCap) {
  for (const int largest : {64, 256, 2048}) {
    core::Scene scene = sharplyLitWall();
    const LightCharts charts = chartByLight(scene, planOf(largest), {}, {});
    EXPECT_LE(charts.atlas.size, largest);
    const TexelMap texels(scene, charts.atlas.size);
    const auto texelsOf = [&](std::uint32_t object) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < texels.texelCount(); ++i)
        count += texels.chartOf(i) >= 0 && texels.fragments(i).front().object == object;
      return count;
    };
    EXPECT_GT(texelsOf(1), 4 * texelsOf(0)) << largest;
    // Blocks of finer texels do the rest (bake_detail_test.cpp).
    const auto atlas =
                   static_cast<std::size_t>(charts.atlas.size) * static_cast<std::size_t>(charts.atlas.size),
               cap = static_cast<std::size_t>(largest) * static_cast<std::size_t>(largest);
    EXPECT_LE(atlas + detailTexelsOf("medium", planOf(largest), charts.atlas.size), cap);
    if (largest == 2048) {
      EXPECT_GT(detailTexelsOf("medium", planOf(largest), charts.atlas.size), atlas);
    }
  }
}

TEST(LightCharts, AreTheSameForAnyNumberOfThreadsAndTheWorldKnowsThem) {
  std::vector<core::Scene> scenes;
  for (const int threads : {0, 1, 3}) {
    core::Scene scene = sharplyLitWall();
    const LightCharts charts = chartByLight(scene, planOf(256), {.threads = threads}, {});
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      const core::Mesh& mesh = scene.meshOf(scene.objects[o]);
      ASSERT_EQ(charts.atlas.charts.meshes[o].uv, mesh.lightmapUv);
      for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const TriangleRecord& r =
            charts.world->record(charts.world->firstTriangle(o) + static_cast<std::uint32_t>(i / 3));
        ASSERT_EQ(r.lightmapUv[i % 3], mesh.lightmapUv[mesh.indices[i]]);
      }
    }
    scenes.push_back(std::move(scene));
  }
  for (std::size_t m = 0; m < scenes[0].meshes.size(); ++m) {
    EXPECT_EQ(scenes[0].meshes[m].lightmapUv, scenes[1].meshes[m].lightmapUv);
    EXPECT_EQ(scenes[0].meshes[m].lightmapUv, scenes[2].meshes[m].lightmapUv);
  }
}

TEST(LightCharts, AnUnknownQualityIsWrongUsage) {
  core::Scene scene = sharplyLitWall();
  EXPECT_THROW(chartByLight(scene, planOf(256), {.quality = "best"}, {}), core::UsageError);
}

TEST(LightCharts, ASceneWithoutSurfaceHasAnAtlas) {
  core::Scene scene;
  EXPECT_NO_THROW(chartByLight(scene, planOf(0), {}, {}));
}

}  // namespace
}  // namespace saccade::raytrace
