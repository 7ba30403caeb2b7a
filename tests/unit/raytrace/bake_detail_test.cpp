// Finer texels where light steps: what they gain against known light, and what they must not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>

#include "raytrace/bake/gather.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/surface.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;

constexpr float kLampHeight = 2, kScreenHeight = 1, kFloorHalf = 1;

/// A floor of [-1, 1]^2 under a point lamp over its middle; a screen at half the height, from x = `edge` on,
/// hides the lamp from all beyond x = 2 edge.
core::Scene screened(float edge, float turn = 0) {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0), {-kFloorHalf, 0, -kFloorHalf}, {0, 0, 2 * kFloorHalf},
         {2 * kFloorHalf, 0, 0});
  b.scene.materials[0].baseColor = Vec3(0.5f);
  if (edge < kFloorHalf) {
    b.patch(SceneBuilder::matte(0), 1, 1, [&](float s, float t) {
      const float x = edge + 4 * s, z = 8 * t - 4;
      return Vec3(x * std::cos(turn) - z * std::sin(turn), kScreenHeight,
                  x * std::sin(turn) + z * std::cos(turn));
    });
  }
  core::PunctualLight lamp;
  lamp.position = {0, kLampHeight, 0};
  lamp.intensity = Vec3(1);
  b.scene.lights.push_back(lamp);
  b.scene.bounds.add(lamp.position);
  return b.scene;
}

double lampAt(float x, float z) {
  const double squared = kLampHeight * kLampHeight + x * x + z * z;
  return kLampHeight / (squared * std::sqrt(squared));
}

/// Root mean square error over the floor, relative to the mean.
double errorOf(const Baked& baked, float edge, float turn = 0) {
  double sum = 0, mean = 0;
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i) {
    for (int k = 0; k < kPoints; ++k) {
      const auto at = [](int n) { return (static_cast<float>(n) + 0.37f) / kPoints * 1.9f - 0.95f; };
      const float x = at(i), z = at(k);
      const double truth = x * std::cos(turn) + z * std::sin(turn) > 2 * edge ? 0 : lampAt(x, z);
      const double error = baked.irradiance(0, {x, 0, z}).y - truth;
      sum += error * error;
      mean += truth;
    }
  }
  return std::sqrt(sum / (kPoints * kPoints)) / (mean / (kPoints * kPoints));
}

BakeOptions options(std::size_t detailTexels) {
  BakeOptions o;
  o.quality = "medium";
  o.photons = 1000;
  o.detailTexels = detailTexels;
  return o;
}

std::size_t blockTexels(const core::MapDetail& detail) {
  std::size_t sum = 0;
  for (const std::uint32_t packed : detail.blocks) {
    if (packed == 0) continue;
    sum += core::MapBlock::unpack(packed).texels();
  }
  return sum;
}

TEST(BakeDetail, AnEdgeAlongTexelsNeedsFewCellsOnlyAcrossIt) {
  constexpr float kEdge = 0.1007f;
  const Baked coarse(screened(kEdge), 32, options(0)), fine(screened(kEdge), 32, options(4000));
  EXPECT_EQ(coarse.maps().detail.height, 0);
  // Cut 32 times across, the edge's error in the square falls 32 times; 4 in the root leave some for the
  // rest.
  EXPECT_LT(errorOf(fine, kEdge), errorOf(coarse, kEdge) / 4);
  for (const std::uint32_t packed : fine.maps().detail.blocks) {
    if (packed == 0) continue;
    const core::MapBlock block = core::MapBlock::unpack(packed);
    EXPECT_LE(std::min(block.columns(), block.rows()), 4);
  }
}

TEST(BakeDetail, AnEdgeAskewIsFollowed) {
  constexpr float kEdge = 0.1007f, kTurn = 0.6f;
  const Baked coarse(screened(kEdge, kTurn), 32, options(0)), fine(screened(kEdge, kTurn), 32, options(8000));
  EXPECT_LT(errorOf(fine, kEdge, kTurn), errorOf(coarse, kEdge, kTurn) / 2);
}

TEST(BakeDetail, MoreTexelsLeaveLessErrorAndAreNotExceeded) {
  constexpr float kEdge = 0.1007f, kTurn = 0.6f;
  double before = 1e9;
  for (const std::size_t most : {500, 2000, 8000}) {
    const Baked baked(screened(kEdge, kTurn), 32, options(most));
    const std::size_t texels = blockTexels(baked.maps().detail);
    EXPECT_LE(texels, most);
    EXPECT_GT(texels, most / 4);
    const double error = errorOf(baked, kEdge, kTurn);
    EXPECT_LT(error, before);
    before = error;
  }
}

TEST(BakeDetail, ASmallAtlasTakesWhatItsRowsHold) {
  BakeOptions o = options(100'000'000);
  o.quality = "high";
  const Baked baked(screened(0.1007f, 0.6f), 16, o);
  EXPECT_GT(baked.maps().detail.height, 0);
  EXPECT_LE(baked.maps().detail.height, core::MapBlock::kLargestCoordinate);
}

TEST(BakeDetail, EvenLightHasNoBlocks) {
  const Baked baked(screened(2 * kFloorHalf), 32, options(100000));
  EXPECT_EQ(baked.maps().detail.height, 0);
  EXPECT_TRUE(baked.maps().detail.blocks.empty());
}

TEST(BakeDetail, NeighboursAgreeAtTheirCommonBorder) {
  constexpr float kEdge = 0.1007f, kTurn = 0.6f;
  const Baked baked(screened(kEdge, kTurn), 32, options(20000));
  const core::IlluminationMaps& maps = baked.maps();
  const auto block = [&](int x, int y) {
    return core::MapBlock::unpack(maps.detail.blocks[static_cast<std::size_t>(y * maps.width + x)]);
  };
  const auto cell = [&](int x, int y) {
    return maps.detail.texels[3 * static_cast<std::size_t>(y * maps.width + x)];
  };
  int pairs = 0;
  for (int y = 0; y < maps.height; ++y) {
    for (int x = 0; x + 1 < maps.width; ++x) {
      const core::MapBlock a = block(x, y), b = block(x + 1, y);
      if (a.packed() == 0 || b.packed() == 0 || a.columns() != b.columns() || a.rows() != b.rows()) continue;
      if (core::MapBlock::unpack(b.packed()).x == 0) continue;
      ++pairs;
      for (int row = 0; row < a.rows(); ++row) {
        EXPECT_EQ(cell(a.x + a.columns(), a.y + row), cell(b.x, b.y + row));
        EXPECT_EQ(cell(b.x - 1, b.y + row), cell(a.x + a.columns() - 1, a.y + row));
      }
    }
  }
  EXPECT_GT(pairs, 5);
}

TEST(BakeDetail, SameBitsForAnyThreadsAndPauses) {
  const core::Scene scene = screened(0.1007f, 0.6f);
  const Baked plain(scene, 32, options(5000));
  BakeOptions threaded = options(5000);
  threaded.threads = 3;
  const Baked again(scene, 32, threaded);
  EXPECT_EQ(plain.maps().detail.blocks, again.maps().detail.blocks);
  EXPECT_EQ(plain.maps().detail.texels, again.maps().detail.texels);

  BakeJob job(plain.world(), plain.maps().width, options(5000));
  std::stop_source stop;
  stop.request_stop();  // a pause after each piece
  while (!job.advance(stop.get_token(), {})) {
  }
  const core::IlluminationMaps paused = job.finish({}, {}, {});
  EXPECT_EQ(plain.maps().detail.blocks, paused.detail.blocks);
  EXPECT_EQ(plain.maps().detail.texels, paused.detail.texels);
}

TEST(BakeDetail, KeptChartsKeepTheirBlocks) {
  const Baked before(screened(0.1007f, 0.6f), 32, options(5000));
  const TexelMap texels(before.scene(), before.maps().width);
  KeptCharts kept;
  kept.previous = &before.maps();
  kept.keep.assign(texels.charts().size(), 1);
  BakeOptions o = options(5000);
  o.kept = &kept;
  o.seed = 7;
  const core::IlluminationMaps after = bakeMaps(before.world(), {}, before.maps().width, o, {});
  EXPECT_EQ(after.detail.blocks, before.maps().detail.blocks);
  EXPECT_EQ(after.detail.texels, before.maps().detail.texels);
}

/// A floor of two halves, alike under a lamp over their common border and an edge across both.
core::Scene halves(float edge) {
  core::Scene scene = screened(edge);
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.5f), {-1, 0, -1}, {0, 0, 1}, {2, 0, 0});
  b.quad(SceneBuilder::matte(0.5f), {-1, 0, 0}, {0, 0, 1}, {2, 0, 0});
  b.patch(SceneBuilder::matte(0), 1, 1,
          [&](float s, float t) { return Vec3(edge + 4 * s, kScreenHeight, 8 * t - 4); });
  b.scene.lights = scene.lights;
  b.scene.bounds.add(scene.bounds);
  return b.scene;
}

/// Light is missing in what the bake knows of charts that are kept; blocks must not be dealt out by that.
TEST(BakeDetail, KeptChartsNeitherRaiseTheWishNorTheMemory) {
  const auto keepFirst = [](const Baked& before, BakeOptions o) {
    const TexelMap texels(before.scene(), before.maps().width);
    KeptCharts kept;
    kept.previous = &before.maps();
    kept.keep.assign(texels.charts().size(), 0);
    for (std::size_t t = 0; t < texels.texelCount(); ++t) {
      if (texels.chartOf(t) >= 0 && texels.fragments(t).front().object == 0)
        kept.keep[static_cast<std::size_t>(texels.chartOf(t))] = 1;
    }
    o.kept = &kept;
    return blockTexels(bakeMaps(before.world(), {}, before.maps().width, o, {}).detail);
  };
  constexpr float kEdge = 0.1007f;
  BakeOptions fine = options(1'000'000);
  fine.quality = "high";
  const Baked wished(halves(kEdge), 32, fine);
  const auto whole = static_cast<double>(blockTexels(wished.maps().detail));
  ASSERT_GT(whole, 0);
  EXPECT_NEAR(static_cast<double>(keepFirst(wished, fine)), whole, 0.05 * whole);

  const Baked bounded(halves(kEdge), 32, options(1200));
  ASSERT_GT(blockTexels(bounded.maps().detail), 600u);
  const std::size_t again = keepFirst(bounded, options(1200));
  EXPECT_LE(again, 1200u);
  EXPECT_GT(again, 600u);
}

/// A cell in the foot of a wall sees half of the sky, one in the open all of it.
TEST(BakeDetail, NearSurfacesPartTheHemisphereByTheCosine) {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.5f), {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  b.quad(SceneBuilder::matte(0.5f), {0, 0, -1}, {0, 2, 0}, {0, 0, 2});
  core::Plan plan;
  plan.lightmapSize = 64;
  const ChartAtlas atlas = makeCharts(b.scene, plan, 64);
  core::applyCharts(b.scene, atlas.charts);
  const World world(b.scene, plan);
  const TexelMap texels(b.scene, atlas.size);
  TexelLight source;
  source.layers[0].assign(texels.texelCount(), Vec3(2));
  GatherOptions gather;
  gather.rays = 1024;
  int atWall = 0, inTheOpen = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0 || texels.fragments(t).front().object != 0) continue;
    const TexelCell cell{4, 4, 1, 1};
    const MeshPoint at = texels.pointOn(t, 0.5f, 0.5f, 0.5f);
    const float x = surfaceOn(world, 0, at.triangle, at.b1, at.b2, true).position.x;
    if (std::abs(x) < 0.04f) continue;  // the cell may lie on the other side than the texel's middle
    const NearLight light = nearLight(world, texels, t, cell, 0, 0.2f, source, gather);
    // What a wall of irradiance 2 and albedo 1/2 sends from its share of the hemisphere; nothing, behind it.
    EXPECT_NEAR(light.irradiance.y, x > 0 ? 1 - light.open : 0, 1e-4);
    if (std::abs(x) > 0.4f) {
      EXPECT_EQ(light.open, 1.0f);
      ++inTheOpen;
    }
    atWall += x > 0 && light.open < 0.7f;
  }
  EXPECT_GT(inTheOpen, 100);
  EXPECT_GT(atWall, 10);
}

class BakeDetailImport : public testing::Test {
 protected:
  core::Scene scene = screened(0.1007f, 0.6f);
  ImportedLight imported;
  void SetUp() override {
    scene.meshes[0].uv1 = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    imported.images.emplace_back(1, 1);
    imported.images[0].at(0, 0) = Vec3(3);
    imported.imageOfObject.assign(scene.objects.size(), -1);
    imported.imageOfObject[0] = 0;
  }
};

TEST_F(BakeDetailImport, IsNotHiddenByBlocks) {
  BakeOptions o = options(5000);
  o.imported = &imported;
  const Baked baked(scene, 32, o);
  EXPECT_EQ(baked.irradiance(0, {0.2f, 0, 0}), Vec3(3));
  EXPECT_EQ(baked.maps().detail.height, 0);
}

/// What a job keeps for going on does not depend on imported light: only the quick end reads that.
TEST_F(BakeDetailImport, MayComeWhenAJobGoesOn) {
  scene = halves(0.1007f);
  scene.meshes[0].uv1 = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  const Baked without(scene, 32, options(5000));
  BakeOptions o = options(5000);
  o.imported = &imported;
  const core::IlluminationMaps with = bakeMaps(without.world(), {}, without.maps().width, o, {});
  ASSERT_LT(blockTexels(with.detail), blockTexels(without.maps().detail));
  ASSERT_GT(blockTexels(with.detail), 0u);

  BakeJob first(without.world(), without.maps().width, options(5000));
  while (!first.advance({}, {})) {
  }
  BakeJob second(without.world(), without.maps().width, o);
  for (std::size_t i = 0; i < second.stages().size(); ++i) {
    BakeStage& to = second.stages()[i];
    const BakeStage& from = first.stages()[i];
    to.done = from.done;
    ASSERT_EQ(to.results.size(), from.results.size());
    std::copy(from.results.begin(), from.results.end(), to.results.begin());
  }
  EXPECT_TRUE(second.advance({}, {}));
  const core::IlluminationMaps resumed = second.finish({}, {}, {});
  EXPECT_EQ(resumed.texels, with.texels);
  EXPECT_EQ(resumed.detail.blocks, with.detail.blocks);
  EXPECT_EQ(resumed.detail.texels, with.detail.texels);
}

}  // namespace
}  // namespace saccade::raytrace
