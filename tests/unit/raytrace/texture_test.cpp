// Texels of textures and maps: wrap modes, filtering, decoding, tiles.
#include <gtest/gtest.h>

#include <random>

#include "core/image_io.h"
#include "core/math/half.h"
#include "raytrace/texture_store.h"
#include "raytrace/world.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::HardCase;

/// 7 x 5 texels, all different: R = column, G = row.
core::Scene sceneWith(core::Wrap wrap, bool nearest, bool srgb) {
  core::Scene scene;
  core::Texture t;
  t.image = core::ImageRgba8(7, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      t.image.at(x, y) = {static_cast<std::uint8_t>(30 * x), static_cast<std::uint8_t>(50 * y), 200,
                          static_cast<std::uint8_t>(x + y)};
    }
  }
  t.wrapS = t.wrapT = wrap;
  t.nearest = nearest;
  t.srgb = srgb;
  scene.textures.push_back(t);
  return scene;
}

Vec2 center(int x, int y) { return {(static_cast<float>(x) + 0.5f) / 7, (static_cast<float>(y) + 0.5f) / 5}; }

int wrapped(int i, int size, core::Wrap wrap) {
  if (wrap == core::Wrap::clamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == core::Wrap::mirror ? 2 * size : size;
  const int r = ((i % period) + period) % period;
  return r < size ? r : 2 * size - 1 - r;
}

TEST(Texture, Hard21EveryTexelUnderEveryWrapMode) {
  HardCase off("tiled texels at centres from -15 to 22 of 7, every wrap mode");
  for (core::Wrap wrap : {core::Wrap::repeat, core::Wrap::clamp, core::Wrap::mirror}) {
    for (bool nearest : {false, true}) {
      const core::Scene scene = sceneWith(wrap, nearest, false);
      const TextureStore store(scene);
      const TextureView view = store.view({0, 0});
      for (int y = -11; y < 16; ++y) {
        for (int x = -15; x < 22; ++x) {
          const core::Vec4 t = view.sample(center(x, y));
          ASSERT_TRUE(off.near(t.x, 30 * wrapped(x, 7, wrap) / 255.0, 1e-4)) << x << " " << y;
          ASSERT_TRUE(off.near(t.y, 50 * wrapped(y, 5, wrap) / 255.0, 1e-4)) << x << " " << y;
          ASSERT_TRUE(off.near(t.w, (wrapped(x, 7, wrap) + wrapped(y, 5, wrap)) / 255.0, 1e-5));
        }
      }
    }
  }
}

TEST(Texture, BilinearBetweenTexelsAndAcrossTheSeam) {
  const core::Scene scene = sceneWith(core::Wrap::repeat, false, false);
  const TextureStore store(scene);
  const TextureView view = store.view({0, 0});
  EXPECT_NEAR(view.sample((center(2, 1) + center(3, 1)) * 0.5f).x, 75 / 255.0, 1e-5);
  EXPECT_NEAR(view.sample((center(2, 1) * 0.75f + center(2, 2) * 0.25f)).y, 62.5 / 255, 1e-5);
  EXPECT_NEAR(view.sample({0, 0.1f}).x, 90 / 255.0, 1e-4);  // columns 6 and 0
  EXPECT_NEAR(view.sample({1, 0.1f}).x, 90 / 255.0, 1e-4);
}

TEST(Texture, ColourIsDecodedAndAlphaIsNot) {
  const core::Scene scene = sceneWith(core::Wrap::repeat, false, true);
  const TextureStore store(scene);
  const core::Vec4 t = store.view({0, 0}).sample(center(4, 2));
  EXPECT_FLOAT_EQ(t.x, core::decodeSrgb(120 / 255.0f));
  EXPECT_FLOAT_EQ(t.z, core::decodeSrgb(200 / 255.0f));
  EXPECT_FLOAT_EQ(t.w, 6 / 255.0f);
}

TEST(Texture, TransformsMoveTheCoordinates) {
  const core::Scene scene = sceneWith(core::Wrap::repeat, false, false);
  const TextureStore store(scene);
  core::TextureSlot slot;
  slot.texture = 0;
  const TextureView plain = store.view(slot);
  EXPECT_FALSE(plain.transformed);
  slot.offset = {0.3f, -0.2f};
  slot.rotation = 1.1f;
  slot.scale = {2, 0.5f};
  const TextureView moved = store.view(slot);
  const float c = std::cos(1.1f), s = std::sin(1.1f);
  for (const Vec2 uv : {Vec2(0), Vec2(0.4f, 0.9f), Vec2(-3.3f, 1.7f)}) {
    const Vec2 scaled = uv * Vec2(2, 0.5f);
    const Vec2 at(0.3f + c * scaled.x + s * scaled.y, -0.2f - s * scaled.x + c * scaled.y);
    EXPECT_LT(glm::length(moved.sample(uv) - plain.sample(at)), 1e-4f);
  }
}

TEST(Texture, UnsoundCoordinatesAndEmptySlots) {
  const core::Scene scene = sceneWith(core::Wrap::repeat, false, false);
  const TextureStore store(scene);
  const float nan = std::nanf("");
  for (float bad : {nan, core::kInfinity, -core::kInfinity, 1e30f, -1e9f}) {
    EXPECT_EQ(store.view({0, 0}).sample({bad, 0.5f}), store.view({0, 0}).sample({0, 0.5f}));
  }
  EXPECT_FALSE(store.view({}));
}

TEST(Maps, Hard21TileSeamsEqualTheUntiledImage) {
  // Tiles of 4 x 2 texels, sizes that are no multiples, places between texels, on edges and outside.
  HardCase off =
      HardCase::counting("irradiance across tile seams that differs from the untiled formula", "look-ups");
  std::mt19937 random(8);
  std::uniform_real_distribution<float> place(-0.3f, 1.3f);
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 5}, {4, 2}, {13, 7}, {64, 64}}) {
    core::IlluminationMaps maps;
    maps.width = w;
    maps.height = h;
    maps.layers = 2;
    for (int i = 0; i < w * h * 2 * 3; ++i)
      maps.texels.push_back(core::toHalf(static_cast<float>(random() % 4096) / 16));
    tests::SceneMaker m;
    m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    World world(m.scene, tests::planOf());
    world.setMaps(&maps);
    int differing = 0;
    for (int i = 0; i < 20000; ++i) {
      const int layer = i & 1;
      Vec2 uv(place(random), place(random));
      if (i % 3 == 0) uv = (glm::floor(uv * Vec2(w, h)) + 0.5f) / Vec2(w, h);  // a texel's centre
      const Vec2 at = glm::clamp(uv * Vec2(w, h) - 0.5f, Vec2(0), Vec2(w - 1, h - 1));
      const glm::ivec2 lo(at), hi = glm::min(lo + 1, glm::ivec2(w - 1, h - 1));
      const Vec2 f = at - Vec2(lo);
      const auto mix = [](const Vec3& a, const Vec3& b, float t) { return a + t * (b - a); };
      const Vec3 truth = mix(mix(maps.texel(lo.x, lo.y, layer), maps.texel(hi.x, lo.y, layer), f.x),
                             mix(maps.texel(lo.x, hi.y, layer), maps.texel(hi.x, hi.y, layer), f.x), f.y);
      differing += world.irradiance(uv, layer) != truth;
    }
    EXPECT_TRUE(off.within(differing, 0)) << w << " x " << h;
  }
}

}  // namespace
}  // namespace saccade::raytrace
