// Finer texels of illumination maps as rays read them: exactly the rule of core/map_detail.h.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "raytrace/world.h"
#include "tests/detail_maps.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

/// With one quad, whose material and place do not matter.
class MapDetail : public testing::Test {
 protected:
  MapDetail() {
    tests::SceneMaker m;
    m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene_ = m.scene;
    world_ = std::make_unique<World>(scene_, tests::planOf());
  }
  core::Scene scene_;
  std::unique_ptr<World> world_;
};

Vec3 mix(const Vec3& a, const Vec3& b, float t) { return a + t * (b - a); }

/// Bilinear between texels of an image of `width` x `rows` that begins at `texels`, at `at` from the middle
/// of the first.
Vec3 bilinear(const std::uint16_t* texels, int width, int rows, const Vec2& at) {
  const auto texel = [&](int x, int y) {
    const std::uint16_t* t = texels + 3 * (std::clamp(y, 0, rows - 1) * width + std::clamp(x, 0, width - 1));
    return Vec3(core::fromHalf(t[0]), core::fromHalf(t[1]), core::fromHalf(t[2]));
  };
  const glm::ivec2 lo(at);
  const Vec2 f = at - Vec2(lo);
  return mix(mix(texel(lo.x, lo.y), texel(lo.x + 1, lo.y), f.x),
             mix(texel(lo.x, lo.y + 1), texel(lo.x + 1, lo.y + 1), f.x), f.y);
}

/// `place` in texels of the atlas, inside it.
Vec3 lookUp(const core::IlluminationMaps& maps, const Vec2& place, int layer) {
  const glm::ivec2 t(place);
  const std::uint32_t packed = maps.detail.blocks[static_cast<std::size_t>(t.y * maps.width + t.x)];
  const auto layerOf = [&](const std::vector<std::uint16_t>& texels, int rows) {
    return texels.data() + 3 * maps.width * rows * layer;
  };
  if (packed == 0) {
    const Vec2 at = glm::clamp(place - 0.5f, Vec2(0), Vec2(maps.width - 1, maps.height - 1));
    return bilinear(layerOf(maps.texels, maps.height), maps.width, maps.height, at);
  }
  const auto b = core::MapBlock::unpack(packed);
  const Vec2 at = Vec2(b.x, b.y) + (place - Vec2(t)) * Vec2(b.columns(), b.rows()) - 0.5f;
  return bilinear(layerOf(maps.detail.texels, maps.detail.height), maps.width, maps.detail.height, at);
}

TEST_F(MapDetail, LookUpsFollowTheRuleExactly) {
  // Powers of two, so that uv times size is exact and the truth knows the same place.
  for (const auto& [w, h] : {std::pair{16, 1}, {16, 8}, {256, 4}}) {
    const core::IlluminationMaps maps = tests::detailMaps(w, h, 2, w == 256 ? 7 : 3, 4);
    ASSERT_TRUE(core::fits(maps.detail, w, h, 2));
    world_->setMaps(&maps);
    std::mt19937 random(9);
    int inBlocks = 0, differing = 0;
    for (int i = 0; i < 40000; ++i) {
      const int layer = i & 1;
      // To sixteenths of a texel: edges, centres and corners too.
      const Vec2 place(static_cast<float>(random() % (16u * w)) / 16,
                       static_cast<float>(random() % (16u * h)) / 16);
      inBlocks +=
          maps.detail.blocks[static_cast<std::size_t>(place.y) * w + static_cast<std::size_t>(place.x)] != 0;
      differing += world_->irradiance(place / Vec2(w, h), layer) != lookUp(maps, place, layer);
    }
    EXPECT_EQ(differing, 0) << w << " x " << h;
    EXPECT_GT(inBlocks, 10000);
    EXPECT_LT(inBlocks, 30000);
  }
}

TEST_F(MapDetail, PlacesOutsideTheAtlasReadItsEdge) {
  const core::IlluminationMaps maps = tests::detailMaps(16, 8, 2, 3, 5);
  world_->setMaps(&maps);
  const float last = std::nextafter(1.0f, 0.0f), nan = std::numeric_limits<float>::quiet_NaN();
  for (int layer = 0; layer < 2; ++layer) {
    for (float s = 0.03f; s < 1; s += 0.05f) {
      EXPECT_EQ(world_->irradiance({-3, s}, layer), world_->irradiance({0, s}, layer));
      EXPECT_EQ(world_->irradiance({s, -core::kInfinity}, layer), world_->irradiance({s, 0}, layer));
      EXPECT_EQ(world_->irradiance({1, s}, layer), world_->irradiance({last, s}, layer));
      EXPECT_EQ(world_->irradiance({s, 1e30f}, layer), world_->irradiance({s, last}, layer));
      EXPECT_EQ(world_->irradiance({nan, s}, layer), world_->irradiance({0, s}, layer));
    }
    EXPECT_EQ(world_->irradiance({0.5f, 0.5f}, 2), Vec3(0));
  }
}

TEST_F(MapDetail, TexelsWithoutABlockAreThoseOfTheSameMapsWithoutDetail) {
  core::IlluminationMaps maps = tests::detailMaps(16, 8, 1, 3, 6);
  world_->setMaps(&maps);
  std::vector<std::pair<Vec2, Vec3>> before;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  while (before.size() < 5000) {
    const Vec2 uv(uniform(random), uniform(random));
    const glm::ivec2 t(uv * Vec2(16, 8));
    if (maps.detail.blocks[static_cast<std::size_t>(t.y * 16 + t.x)] == 0)
      before.emplace_back(uv, world_->irradiance(uv, 0));
  }
  maps.detail = {};
  world_->setMaps(&maps);
  int differing = 0;
  for (const auto& [uv, value] : before) differing += world_->irradiance(uv, 0) != value;
  EXPECT_EQ(differing, 0);
}

}  // namespace
}  // namespace saccade::raytrace
