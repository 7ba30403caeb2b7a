// Texels of an atlas and the cells that they are cut into.
#include "raytrace/bake/texel_map.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/raytrace/bake_scenes.h"
#include "raytrace/bake/charts.h"

namespace saccade::raytrace {
namespace {

TEST(TexelMap, PointsOfACellLieInIt) {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.5f), {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  core::Plan plan;
  plan.lightmapSize = 64;
  const ChartAtlas atlas = makeCharts(b.scene, plan, 16);
  core::applyCharts(b.scene, atlas.charts);
  const TexelMap texels(b.scene, atlas.size);
  const core::Mesh& mesh = b.scene.meshes[0];
  const TexelCell cell{4, 2, 3, 1};
  int found = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    const std::optional<MeshPoint> point = texels.pointIn(t, cell, {0.5f, 0.25f});
    if (!point) continue;
    ++found;
    const std::uint32_t* corner = &mesh.indices[std::size_t{3} * point->triangle];
    const core::Vec2 uv = mesh.lightmapUv[corner[0]] * (1 - point->b1 - point->b2) +
                          mesh.lightmapUv[corner[1]] * point->b1 + mesh.lightmapUv[corner[2]] * point->b2;
    const Plane2 place =
        Plane2(core::placeInAtlas(b.scene.objects[0].lightmapScaleOffset, uv)) * double(texels.size()) -
        texels.cornerOf(t);
    EXPECT_NEAR(place.x, 3.5 / 4, 1e-4);
    EXPECT_NEAR(place.y, 1.25 / 2, 1e-4);
  }
  EXPECT_GT(found, 100);
}

TEST(TexelMap, CellsHaveNumbersOfTheirOwnWithRoomForTheLayer) {
  std::set<std::uint32_t> numbers{TexelCell().number(), TexelCell().number() + 1};
  std::size_t count = 2;
  for (int columns = 1; columns <= 64; columns *= 2) {
    for (int rows = 1; rows <= 64; rows *= 2) {
      if (columns * rows == 1) continue;
      for (int x = 0; x < columns; ++x) {
        for (int y = 0; y < rows; ++y) {
          const std::uint32_t number = TexelCell{columns, rows, x, y}.number();
          numbers.insert(number);
          numbers.insert(number + 1);
          count += 2;
        }
      }
    }
  }
  EXPECT_EQ(numbers.size(), count);
}

}  // namespace
}  // namespace saccade::raytrace
