// Scenes of any size are of the size that they say, and all in view.
#include <gtest/gtest.h>

#include "bench/growth/ball_scene.h"
#include "bench/growth/frame.h"
#include "core/camera.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

std::size_t nonDiffuse(const core::Scene& scene) { return scene.idCount(); }

TEST(BallScene, RingsAreTheMostThatFit) {
  for (const std::size_t triangles : {24u, 25u, 1000u, 100'000u, 1'000'000u}) {
    const int rings = ringsFor(triangles);
    EXPECT_LE(trianglesOfBall(rings), triangles);
    EXPECT_GT(trianglesOfBall(rings + 1), triangles);
  }
  EXPECT_EQ(ringsFor(0), 3);
}

TEST(BallScene, TrianglesComeWithinTheStepOfOneRing) {
  for (const std::size_t triangles : {10'000u, 100'000u, 1'000'000u}) {
    const auto wanted = static_cast<double>(triangles);
    const core::Scene scene = makeBallScene({triangles, 100, true});
    EXPECT_NEAR(static_cast<double>(scene.triangleCount()), wanted, 0.25 * wanted);
  }
}

TEST(BallScene, InstancesAreStoredOnce) {
  const core::Scene shared = makeBallScene({100'000, 100, true}),
                    copied = makeBallScene({100'000, 100, false});
  EXPECT_EQ(shared.triangleCount(), copied.triangleCount());
  EXPECT_EQ(copied.storedTriangleCount(), copied.triangleCount());
  EXPECT_LT(shared.storedTriangleCount(), shared.triangleCount() / 50);
}

TEST(BallScene, HalfOfTheBallsAreMirrorsAndAllAreWatertight) {
  for (const std::size_t balls : {10u, 100u, 1000u}) {
    const core::Scene scene = makeBallScene({100 * balls, balls, false});
    EXPECT_EQ(scene.objects.size(), balls + 1);  // the panel
    EXPECT_NEAR(static_cast<double>(nonDiffuse(scene)), static_cast<double>(balls) / 2, 1);
    std::size_t closed = 0;
    for (const core::Object& o : scene.objects) closed += o.closed ? 1 : 0;
    EXPECT_EQ(closed, balls);
  }
}

TEST(BallScene, TheCameraSeesEveryBallWhole) {
  for (const std::size_t balls : {10u, 100u, 1000u}) {
    const core::Scene scene = makeBallScene({100 * balls, balls, true});
    const core::View view(scene.cameras[0], 512, 512, scene.bounds);
    for (const core::Object& o : scene.objects) {
      if (!o.closed) continue;
      for (const core::Vec3& corner : {o.bounds.lo, o.bounds.hi}) {
        const auto seen = view.project(corner);
        ASSERT_TRUE(seen);
        EXPECT_GE(seen->pixel.x, 0);
        EXPECT_GE(seen->pixel.y, 0);
        EXPECT_LE(seen->pixel.x, 512);
        EXPECT_LE(seen->pixel.y, 512);
      }
    }
  }
}

TEST(FrameSize, SurvivesTheWayToItsProcess) {
  FrameSize size;
  size.scene = {1'000'000, 316, true};
  size.samples = 316;
  size.side = 2828;
  const FrameSize back = FrameSize::of(size.arguments());
  EXPECT_EQ(back.arguments(), size.arguments());
  EXPECT_EQ(back.scene.triangles, size.scene.triangles);
  EXPECT_EQ(back.scene.balls, size.scene.balls);
  EXPECT_TRUE(back.scene.instanced);
  EXPECT_EQ(back.samples, size.samples);
  EXPECT_EQ(back.side, size.side);
  EXPECT_THROW(FrameSize::of({"1"}), core::UsageError);
}

TEST(FrameWithoutTracing, SplatsWhatTheCacheHoldsAndCountsTheScene) {
  FrameSize size;
  size.scene = {10'000, 16, false};
  size.samples = 5'000;
  size.side = 128;
  const Figures f = frameWithoutTracing(size.arguments(), {});
  EXPECT_GT(f.at("samples"), 4'000);
  EXPECT_LE(f.at("samples"), 5'000);
  EXPECT_EQ(f.at("pixels"), 128 * 128);
  EXPECT_EQ(f.at("objects"), 17);
  EXPECT_NEAR(f.at("frame"), f.at("age") + f.at("draw") + f.at("warp") + f.at("composite"),
              0.5 * f.at("frame_max"));
  EXPECT_GE(f.at("bytes"), f.at("scene_bytes"));
}

}  // namespace
}  // namespace saccade::bench
