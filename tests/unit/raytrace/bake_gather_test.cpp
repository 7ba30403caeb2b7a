// Indirect light and caustics of the illumination maps: particles by kind, final gathering.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/specular_albedo.h"
#include "raytrace/bake/density.h"
#include "raytrace/bake/gather.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;

core::Material metal(float roughness) {
  core::Material m = Builder::matte(1);
  m.metallic = 1;
  m.roughness = roughness;
  return m;
}

/// A charted scene as the stages of a bake see it.
struct Stage {
  explicit Stage(core::Scene built, int atlasSize = 64) : scene(std::move(built)) {
    core::Plan plan;
    plan.lightmapSize = atlasSize;
    const ChartAtlas atlas = makeCharts(scene, plan, atlasSize);
    core::applyCharts(scene, atlas.charts);
    world = std::make_unique<World>(scene, plan);
    texels = std::make_unique<TexelMap>(scene, atlas.size);
    open = std::make_unique<OpenArea>(*texels, 1);
    open->probe(*world, *texels, 0, allBlocks(texels->texelCount()), 0, {});
  }
  /// Calls visit(texel) for those with surface.
  template <class Visit>
  void forEachTexel(Visit&& visit) const {
    for (std::size_t t = 0; t < texels->texelCount(); ++t) {
      if (texels->chartOf(t) >= 0 && texels->area(t) > 0) visit(t);
    }
  }
  double watts(const ParticleState& state, int plane) const {
    double sum = 0;
    forEachTexel([&](std::size_t t) { sum += static_cast<double>(state.flux.cell(t, plane).rgb[1]); });
    return sum / FluxGrid::kUnitsPerWeight * wattsPerWeight(*world, state.emitted);
  }
  double causticWatts(const ParticleState& state) const { return watts(state, state.causticPlane(0)); }
  double indirectWatts(const ParticleState& state) const { return watts(state, state.indirectPlane(0)); }
  std::vector<DirectEstimate> gather(const TexelLight& source, const GatherOptions& options) const {
    std::vector<DirectEstimate> out(texels->texelCount());
    gatherIrradiance(*world, *texels, *open, 0, allBlocks(texels->texelCount()), source, options, {}, out);
    return out;
  }
  TexelLight constantLight(float irradiance) const {
    TexelLight light;
    light.layers[0].assign(texels->texelCount(), Vec3(irradiance));
    return light;
  }

  core::Scene scene;
  std::unique_ptr<World> world;
  std::unique_ptr<TexelMap> texels;
  std::unique_ptr<OpenArea> open;
};

/// A unit box from inside, all walls but the one at x = 1 alike.
core::Scene boxWithWall(const core::Material& walls, const core::Material& wall) {
  Builder b;
  b.box(walls, Vec3(0), Vec3(1), true);
  b.scene.materials[static_cast<std::size_t>(b.scene.objects[5].material)] = wall;
  return std::move(b.scene);
}

TEST(BakeParticles, EachKindOfLightArrivesInItsOwnGridWithinOnePercent) {
  // Five walls glow with L and reflect rho, the sixth is a mirror: pi L times the mirror's area comes by way
  // of it, pi L rho / (1 - rho) times the walls' area by way of the walls.
  const Stage s(boxWithWall(Builder::matte(0.5f, Vec3(1)), metal(0)));
  ParticleState state(*s.world, s.texels->texelCount(), 1);
  traceParticles(*s.world, *s.texels, {.whole = 200000, .threads = 2}, 200000, {}, state);
  EXPECT_NEAR(s.causticWatts(state) / core::kPi, 1, 0.01);
  EXPECT_NEAR(s.indirectWatts(state) / (5 * core::kPi), 1, 0.01);
}

TEST(BakeParticles, ARoughWallCastsWhatItsAlbedoTableSaysWithinOnePercent) {
  const Stage s(boxWithWall(Builder::matte(0.5f, Vec3(1)), metal(0.6f)));
  ParticleState state(*s.world, s.texels->texelCount(), 1);
  traceParticles(*s.world, *s.texels, {.caustic = 200000, .threads = 2}, 200000, {}, state);
  const core::AlbedoPair albedo = core::meanAlbedo(0.6f);
  EXPECT_NEAR(s.causticWatts(state) / core::kPi, albedo.scale + albedo.bias, 0.01);
  EXPECT_EQ(s.indirectWatts(state), 0);
}

TEST(BakeParticles, AGlossyFloorSplitsItsLightAsItsLobesDo) {
  // Under a glossy coat over Lambert: particles stopped at the first diffuse surface leave the caustics as
  // they are.
  core::Material glossy = Builder::matte(0.6f);
  glossy.specular = 1;
  glossy.roughness = 0.3f;
  const Stage s(boxWithWall(Builder::matte(0.5f, Vec3(1)), glossy));
  ParticleState whole(*s.world, s.texels->texelCount(), 1), caustic(*s.world, s.texels->texelCount(), 1);
  traceParticles(*s.world, *s.texels, {.whole = 300000, .threads = 2}, 300000, {}, whole);
  traceParticles(*s.world, *s.texels, {.caustic = 300000, .seed = 2, .threads = 2}, 300000, {}, caustic);
  EXPECT_NEAR(s.causticWatts(caustic) / s.causticWatts(whole), 1, 0.03);
}

TEST(BakeParticles, ScenesWithoutSpecularSurfacesKeepNoGridOfCaustics) {
  const Stage matte(boxWithWall(Builder::matte(0.5f, Vec3(1)), Builder::matte(0.7f)));
  EXPECT_FALSE(ParticleState(*matte.world, matte.texels->texelCount(), 1).caustics);
}

TEST(BakeGather, UnderEvenLightEveryRayBringsTheAlbedo) {
  // No ray differs from another: also by way of a mirror.
  for (const float albedo : {0.2f, 0.5f, 0.9f}) {
    core::Scene scenes[] = {boxWithWall(Builder::matte(albedo), Builder::matte(albedo)),
                            boxWithWall(Builder::matte(albedo), metal(0))};
    for (core::Scene& scene : scenes) {
      const Stage s(std::move(scene));
      const std::vector<DirectEstimate> out = s.gather(s.constantLight(3), {.rays = 4, .threads = 2});
      s.forEachTexel([&](std::size_t t) {
        ASSERT_NEAR(out[t].irradiance.y, 3 * albedo, 1e-4) << t;
        ASSERT_NEAR(out[t].variance, 0, 1e-6) << t;
      });
    }
  }
}

TEST(BakeGather, OpenEdgesAndBlackBacksBringNothing) {
  Builder b;  // a plate faces the back of another
  const int plate = b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  b.quad(Builder::matte(0.8f), Vec3(0, 0.5f, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  const Stage s(std::move(b.scene));
  const std::vector<DirectEstimate> out = s.gather(s.constantLight(3), {.rays = 8});
  s.forEachTexel([&](std::size_t t) {
    if (s.texels->fragments(t)[0].object == static_cast<std::uint32_t>(plate)) {
      ASSERT_EQ(out[t].irradiance, Vec3(0));
    }
  });
}

/// A floor of 1 m^2 under a sheet of 0.02 m^2 that lies 1 mm above it.
TEST(OpenArea, WhatStandsOnAFloorTakesItsAreaFromTheTexelsBelow) {
  Builder b;
  const int floor = b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  b.quad(Builder::matte(0.5f), Vec3(0.7f, 0.001f, 0.9f), Vec3(0.1f, 0, 0), Vec3(0, 0, -0.2f));
  const Stage s(std::move(b.scene));
  double area = 0, open = 0;
  s.forEachTexel([&](std::size_t t) {
    if (s.texels->fragments(t)[0].object != static_cast<std::uint32_t>(floor)) return;
    area += s.texels->area(t);
    open += s.open->areas(0)[t];
  });
  EXPECT_NEAR(area, 1, 1e-4);
  EXPECT_NEAR(open, 1 - 0.02, 0.002);
}

TEST(BakeDensity, ASlopeStaysASlopeUpToTheBordersOfItsChart) {
  Builder b;
  b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  const Stage s(std::move(b.scene));
  std::vector<DirectEstimate> rising(s.texels->texelCount());
  const auto truth = [&](std::size_t t) {
    const auto size = static_cast<std::size_t>(s.texels->size());
    return 10 + 0.1f * static_cast<float>(t % size) + 0.2f * static_cast<float>(t / size);
  };
  s.forEachTexel([&](std::size_t t) { rising[t] = {Vec3(truth(t)), 100}; });  // so much noise: wide windows
  double watts = 0;
  const FluxGrid flux = fluxOf(s.open->areas(0), rising, watts);
  DensityOptions options;
  options.doubt = 0;
  options.maxRadius = 16;
  std::vector<DensityEstimate> out(s.texels->texelCount());
  estimateDensity(*s.texels, s.open->areas(0), flux, 0, watts, options, {}, {}, out);
  s.forEachTexel([&](std::size_t t) {
    ASSERT_NEAR(out[t].irradiance.y / truth(t), 1, 1e-3);
    ASSERT_LT(out[t].relativeError, 0.1) << "averaged over many texels";
  });
}

TEST(BakeDensity, OneBrightRayAmongManyTexelsIsSpreadOverItsWindow) {
  Builder b;
  b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  const Stage s(std::move(b.scene), 512);
  std::vector<DirectEstimate> dim(s.texels->texelCount());
  s.forEachTexel([&](std::size_t t) { dim[t] = {Vec3(0.001f), 1e-8f}; });
  const std::size_t firefly = s.texels->texelCount() / 2 + 256;
  dim[firefly] = {Vec3(4), 16};  // 4000 times the mean: its square is far beyond what is usual
  double watts = 0;
  const FluxGrid flux = fluxOf(s.open->areas(0), dim, watts);
  DensityOptions options;
  options.confidence = 1.5f;
  options.doubt = 0;
  options.maxRadius = 11;
  options.pooledRadius = 4;
  std::vector<DensityEstimate> out(s.texels->texelCount());
  estimateDensity(*s.texels, s.open->areas(0), flux, 0, watts, options, {}, {}, out);
  // Alone in the widest window, 23 texels wide, under a bell that is 1.2^2 / (1.2 - 1/3)^2 times its mean.
  s.forEachTexel([&](std::size_t t) { ASSERT_LT(out[t].irradiance.y, 0.001 + 2 * 4.0 / (23 * 23)); });
}

TEST(BakeGather, TheSameBitsForAnyThreadsAndBlocks) {
  core::Material glossy = Builder::matte(0.6f);
  glossy.specular = 1;
  glossy.roughness = 0.3f;
  const Stage s(boxWithWall(Builder::matte(0.5f), glossy), 128);
  TexelLight light = s.constantLight(1);
  for (std::size_t t = 0; t < light.layers[0].size(); ++t) light.layers[0][t] *= static_cast<float>(t % 7);
  const std::vector<DirectEstimate> inOne = s.gather(light, {.rays = 4});
  std::vector<DirectEstimate> inParts(s.texels->texelCount());
  const BlockRange all = allBlocks(s.texels->texelCount());
  for (std::size_t block = all.last; block-- > all.first;) {
    gatherIrradiance(*s.world, *s.texels, *s.open, 0, {block, block + 1}, light, {.rays = 4, .threads = 3},
                     {}, inParts);
  }
  for (std::size_t t = 0; t < inOne.size(); ++t) {
    ASSERT_EQ(inOne[t].irradiance, inParts[t].irradiance);
    ASSERT_EQ(inOne[t].variance, inParts[t].variance);
  }
}

}  // namespace
}  // namespace saccade::raytrace
