// Warping: from camera to camera by projection, mask test and depth test.
#include <gtest/gtest.h>

#include <cmath>

#include "render/splat/sample_cache.h"
#include "tests/hard_case.h"
#include "tests/unit/render/splat_fixture.h"

namespace saccade::render {
namespace {

using core::Sample;
using core::SampleBatch;
using core::Vec2;
using core::Vec3;
using core::Vec4;
using core::View;
using namespace testing;
using tests::HardCase;

constexpr std::size_t kPlenty = std::size_t{64} << 20;

View viewAt(const Vec3& eye, const Vec3& at, int width = 64, int height = 48, float fov = 60) {
  core::Camera camera;
  camera.eye = eye;
  camera.at = at;
  camera.fovYDegrees = fov;
  return View(camera, width, height, unitScene());
}

/// Looking down -z from (x, y, z).
View ahead(const Vec3& eye, int width = 64, int height = 48, float fov = 60) {
  return viewAt(eye, eye - Vec3(0, 0, 1), width, height, fov);
}

/// The plane z = 0 in one object.
Surface wall(const View& view, int x, int y) { return {planeDepth(view, x, y, {0, 0, 1}, 0), 1}; }

/// A steep plane, in stripes of three ids and a diffuse one that belong to the world.
Surface stripes(const View& view, int x, int y) {
  const float depth = planeDepth(view, x, y, glm::normalize(Vec3(0.9f, 0.2f, 0.5f)), -1);
  const Vec3 p = view.camera().eye +
                 depth * view.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
  const int stripe = static_cast<int>(std::floor(3 * p.y)) & 3;
  if (!(depth > view.zNear() && depth < view.zFar())) return {view.zFar(), 0};
  return {depth, stripe == 0 ? 0 : 299 + static_cast<std::uint32_t>(stripe)};
}

void fill(SampleCache& cache, const View& view, std::vector<Sample> samples) {
  cache.age(view, {});
  SampleBatch batch;
  batch.samples = std::move(samples);
  cache.add(batch, cache.cameraAge());
}

TEST(SampleCacheWarp, Hard24TheSameCameraGivesTheSamePicture) {
  HardCase changed = HardCase::counting("pixels that the identity warp changes", "pixels");
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 5}, {150, 110}}) {
    const View view = viewAt({0.4f, 0.3f, 3}, {0, 0, 0}, w, h);
    const auto frame = makeFrame(view, stripes);
    ASSERT_GT(frame->nonDiffusePixels, 0u);
    for (int finest = 3; finest <= 7; ++finest) {
      const std::vector<Sample> samples = latticeSamples(*frame, finest);
      CorrectionLayer fresh, warped;
      fresh.beginFrame(frame);
      for (const Sample& s : samples) fresh.splat(s);
      SampleCache cache(kPlenty);
      fill(cache, view, samples);
      cache.age(view, {});
      warped.beginFrame(frame);
      const auto result = cache.warp(*frame, warped);
      EXPECT_EQ(result.splatted, samples.size());
      EXPECT_EQ(result.dropped + result.hidden + result.offscreen, 0u);
      EXPECT_EQ(warped.exactCount(), 0u);
      const auto a = fresh.pixels(), b = warped.pixels();
      const std::vector<Vec4> before(a.begin(), a.end()), after(b.begin(), b.end());
      ASSERT_TRUE(changed.within(tests::differing(before, after), 0)) << w << "x" << h << " level " << finest;
      ASSERT_EQ(fresh.coveredCount(), warped.coveredCount());
    }
  }
}

TEST(SampleCacheWarp, AWholePixelTranslationShiftsThePicture) {
  const View before = ahead({0, 0, 2});
  const float pixel = 2 * 2 * std::tan(30 * core::kPi / 180) / 48;  // metres on the wall
  const int dx = 5, dy = -3;
  const View after = ahead({pixel * dx, -pixel * dy, 2});
  const auto old = makeFrame(before, wall), frame = makeFrame(after, wall);
  std::vector<Sample> samples = latticeSamples(*old, 7);
  for (Sample& s : samples) s.level = 7;  // so that all footprints are one pixel
  SampleCache cache(kPlenty);
  fill(cache, before, samples);
  cache.age(after, {10, 1, 30});
  CorrectionLayer layer;
  layer.beginFrame(frame);
  const auto result = cache.warp(*frame, layer);
  EXPECT_EQ(result.hidden, 0u);
  EXPECT_EQ(result.offscreen, samples.size() - (64 - 5) * (48 - 3));
  EXPECT_EQ(cache.size(), samples.size());
  const auto pixels = layer.pixels();
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int fromX = x + dx, fromY = y + dy;
      const bool known = fromX < 64 && fromY >= 0;
      const Vec4 expected =
          known ? Vec4(samples[static_cast<std::size_t>(fromY * 64 + fromX)].correction, 0) : Vec4(0);
      ASSERT_EQ(pixels[frame->index(x, y)], expected) << x << ", " << y;
    }
  }
}

TEST(SampleCacheWarp, ASurfaceDoesNotHideItself) {
  // A steep plane, moved by fractions of pixels in all directions: every sample inside is visible.
  const auto steep = [](const View& view, int x, int y) {
    return Surface{planeDepth(view, x, y, glm::normalize(Vec3(1, 0, 0.12f)), -1), 4};
  };
  const View before = viewAt({0, 0, 3}, {0, 0, 0});
  std::mt19937 random(6);
  std::uniform_real_distribution<float> u(-0.02f, 0.02f);
  const auto old = makeFrame(before, steep);
  std::vector<Sample> samples;
  for (const Sample& s : latticeSamples(*old, 7)) {
    if (s.viewDepth > 0 && s.viewDepth < before.zFar()) samples.push_back(s);
  }
  ASSERT_GT(samples.size(), 500u);
  for (int i = 0; i < 20; ++i) {
    SampleCache cache(kPlenty);
    fill(cache, before, samples);
    const View after = viewAt(Vec3(u(random), u(random), 3 + u(random)), Vec3(u(random), u(random), 0));
    cache.age(after, {10, 1, 30});
    const auto frame = makeFrame(after, [&](const View& view, int x, int y) {
      const Surface s = steep(view, x, y);
      return s.viewDepth > 0 && s.viewDepth < view.zFar() ? s : Surface{view.zFar(), 0};
    });
    CorrectionLayer layer;
    layer.beginFrame(frame);
    // But for those that fall behind the far end of the plane.
    EXPECT_LE(cache.warp(*frame, layer).hidden, 100u);
  }
}

TEST(SampleCacheWarp, AnObjectThatHidesPartOfItselfHidesItsSamples) {
  const View view = ahead({0, 0, 2});
  const auto open = makeFrame(view, wall);
  const auto curtain = makeFrame(view, [](const View& v, int x, int y) {
    return Surface{x < 30 ? 1.5f : planeDepth(v, x, y, {0, 0, 1}, 0), 1};  // the same id
  });
  SampleCache cache(kPlenty);
  fill(cache, view, latticeSamples(*open, 7));
  cache.age(view, {});
  CorrectionLayer layer;
  layer.beginFrame(curtain);
  const auto result = cache.warp(*curtain, layer);
  EXPECT_EQ(result.hidden, 30u * 48u);
  EXPECT_EQ(result.splatted, 34u * 48u);
  EXPECT_EQ(cache.size(), 64u * 48u);
}

TEST(SampleCacheWarp, OtherObjectsPixelsAreNotTouched) {
  const View before = ahead({0, 0, 2}), after = ahead({0.1f, 0.07f, 2});
  const auto checked = [](const View& v, int x, int y) {
    return Surface{planeDepth(v, x, y, {0, 0, 1}, 0), static_cast<std::uint32_t>(x / 5 + y / 4) % 3 * 200};
  };
  const auto old = makeFrame(before, checked), frame = makeFrame(after, checked);
  SampleCache cache(kPlenty);
  std::vector<Sample> samples = latticeSamples(*old, 7);
  for (Sample& s : samples) s.correction.x = static_cast<float>(s.id);
  fill(cache, before, samples);
  cache.age(after, {});
  CorrectionLayer layer;
  layer.beginFrame(frame);
  EXPECT_GT(cache.warp(*frame, layer).hidden, 100u);
  const auto pixels = layer.pixels();
  EXPECT_GT(layer.coveredCount(), 1000u);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_TRUE(pixels[i] == Vec4(0) || pixels[i].x == frame->baseAndId[i].w) << i;
  }
}

TEST(SampleCacheWarp, Hard24BehindTheCameraIsSkippedButKept) {
  HardCase shown = HardCase::counting("samples of w <= 0 that are splatted", "pixels"),
           lost = HardCase::counting("samples of w <= 0 that do not come back", "samples");
  const View view = ahead({0, 0, 2}), back = viewAt({0, 0, 2}, {0, 0, 3});
  const auto frame = makeFrame(view, wall);
  const auto behind = makeFrame(back, [](const View&, int, int) { return Surface{1, 1}; });
  SampleCache cache(kPlenty);
  fill(cache, view, latticeSamples(*frame, 6));
  const std::size_t size = cache.size();
  cache.age(back, {});
  CorrectionLayer layer;
  layer.beginFrame(behind);
  EXPECT_TRUE(
      lost.near(static_cast<double>(cache.warp(*behind, layer).offscreen), static_cast<double>(size), 0));
  EXPECT_TRUE(shown.within(layer.coveredCount(), 0));
  // In the very plane of the eye: w = 0 but for rounding.
  const View within = ahead({0, 0, 0});
  const auto none = makeFrame(within, [](const View&, int, int) { return Surface{1, 1}; });
  cache.age(within, {10, 1, 30});
  layer.beginFrame(none);
  EXPECT_TRUE(
      lost.near(static_cast<double>(cache.warp(*none, layer).offscreen), static_cast<double>(size), 0));
  EXPECT_TRUE(shown.within(layer.coveredCount(), 0));
  cache.age(view, {10, 1, 30});
  layer.beginFrame(frame);
  EXPECT_TRUE(
      lost.near(static_cast<double>(cache.warp(*frame, layer).splatted), static_cast<double>(size), 0));
}

TEST(SampleCacheWarp, ComingNearerLeavesNoHoles) {
  // By walking, and by a narrower field of view.
  for (const auto& [z, fov] :
       {std::pair{2.0f, 60.0f}, {1.9f, 60.0f}, {1.0f, 60.0f}, {0.3f, 60.0f}, {2.0f, 20.0f}}) {
    const View before = ahead({0, 0, 2}), after = ahead({0, 0, z}, 64, 48, fov);
    SampleCache cache(kPlenty);
    fill(cache, before, latticeSamples(*makeFrame(before, wall), 7));
    cache.age(after, {10, 1, 30});
    const auto frame = makeFrame(after, wall);
    CorrectionLayer layer;
    layer.beginFrame(frame);
    cache.warp(*frame, layer);
    EXPECT_EQ(layer.coveredCount(), 64u * 48u) << "z " << z << ", fov " << fov;
  }
}

TEST(SampleCacheWarp, GoingAwayDoesNotDependOnTheOrder) {
  const View before = ahead({0, 0, 2}), middle = ahead({0.01f, 0, 2.1f}), after = ahead({0, 0, 7});
  std::vector<Sample> first = latticeSamples(*makeFrame(before, wall), 7);
  std::vector<Sample> second = latticeSamples(*makeFrame(middle, wall), 5);
  for (Sample& s : second) s.correction.x += 1;
  const auto frame = makeFrame(after, wall);
  std::mt19937 random(7);
  std::vector<Vec4> picture;
  for (int i = 0; i < 5; ++i) {
    SampleCache cache(kPlenty);
    fill(cache, before, first);
    cache.age(middle, {10, 1, 30});
    SampleBatch batch;
    batch.samples = second;
    cache.add(batch, cache.cameraAge());
    cache.age(after, {10, 1, 30});
    CorrectionLayer layer;
    layer.beginFrame(frame);
    const auto result = cache.warp(*frame, layer);
    EXPECT_GT(result.dropped, 10u);
    const auto pixels = layer.pixels();
    if (i == 0) picture.assign(pixels.begin(), pixels.end());
    ASSERT_TRUE(std::equal(pixels.begin(), pixels.end(), picture.begin(), picture.end()));
    std::shuffle(first.begin(), first.end(), random);
    std::shuffle(second.begin(), second.end(), random);
  }
}

TEST(SampleCacheWarp, RestingAgainAndAgainDoesNotFillTheCache) {
  const View view = ahead({0, 0, 2});
  const auto frame = makeFrame(view, wall);
  const std::vector<Sample> samples = latticeSamples(*frame, 7);
  SampleCache cache(kPlenty);
  CorrectionLayer layer;
  for (int rest = 0; rest < 10; ++rest) {
    fill(cache, view, samples);
    EXPECT_EQ(cache.size(), rest == 0 ? samples.size() : 2 * samples.size());
    cache.age(view, {});
    layer.beginFrame(frame);
    EXPECT_EQ(cache.warp(*frame, layer).dropped, rest == 0 ? 0 : samples.size());
    EXPECT_EQ(cache.size(), samples.size());
  }
  cache.forEach([&](const Sample&, std::uint64_t age) { EXPECT_EQ(age, cache.cameraAge() - 1); });
}

TEST(SampleCacheWarp, AYoungFineSampleDoesNotReplaceAnOldCoarseOne) {
  const View view = ahead({0, 0, 2});
  const auto frame = makeFrame(view, wall);
  SampleCache cache(kPlenty);
  fill(cache, view, {sampleAt(*frame, 20, 20, 4)});
  fill(cache, view, {sampleAt(*frame, 20, 20, 6)});
  cache.age(view, {});
  CorrectionLayer layer;
  layer.beginFrame(frame);
  EXPECT_EQ(cache.warp(*frame, layer).dropped, 0u);
  EXPECT_EQ(layer.coveredCount(), 13u * 13u);
  EXPECT_EQ(layer.shownAt(20, 20)->level, 6);
  EXPECT_EQ(layer.shownAt(20, 20)->ageFrames, 1);
  EXPECT_EQ(layer.shownAt(24, 20)->ageFrames, 2);
}

}  // namespace
}  // namespace saccade::render
