// Numerics 21, 27 and 28 of the hard cases, through the whole frame loop: odd cameras and sizes, and any
// number of threads, end at the ray-traced image.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard_case.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using app::ImageSize;
using core::Vec3;
using tests::HardCase;

/// cornell, off screen.
class HardViews : public testing::Test {
 protected:
  const app::Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  app::Headless gl_{tests::runOn("osmesa"), workspace_};
  const core::Camera camera_ = workspace_.scene.cameras[0];

  /// Converged picture of the loop.
  core::ImageRgb converge(FrameLoop& loop, const core::Camera& camera, ImageSize size) {
    loop.step(camera, size, FrameBudget::untilConverged());
    EXPECT_TRUE(loop.converged());
    return loop.linear();
  }
  /// Pixels of a view that are not as ray traced, or not finite.
  double wrongPixels(const core::Camera& camera, ImageSize size = {120, 90}) {
    FrameLoop loop(workspace_, *gl_.renderer, {.threads = 2});
    const core::ImageRgb image = converge(loop, camera, size);
    double unsound = 0;
    for (const Vec3& p : image.pixels()) unsound += !std::isfinite(p.x + p.y + p.z);
    return unsound + tests::differing(image.pixels(), tests::rayTraced(workspace_, loop.frame()).pixels());
  }
  /// The first object with transmission.
  const core::Object& glass() const {
    for (const core::Object& o : workspace_.scene.objects)
      if (workspace_.scene.materials[static_cast<std::size_t>(o.material)].transmission > 0) return o;
    throw core::Error("cornell has no glass");
  }
};

TEST_F(HardViews, Hard27CameraInsideGlass) {
  core::Camera inside = camera_;
  const core::Bounds& box = glass().bounds;
  inside.eye = 0.5f * (box.lo + box.hi);
  HardCase wrong = HardCase::counting("pixels from inside glass not as ray traced or not finite", "pixels");
  for (const Vec3& towards : {Vec3(1, 0, 0), Vec3(0, -1, 0.1f), Vec3(-0.3f, 0.2f, -1)}) {
    inside.at = inside.eye + towards;
    EXPECT_TRUE(wrong.within(wrongPixels(inside), 0)) << towards.x;
  }
}

TEST_F(HardViews, Hard27CameraOnASurface) {
  HardCase wrong = HardCase::counting("pixels from on a surface not as ray traced or not finite", "pixels");
  // On a corner of the glass and in the middle of a triangle of every object, along it and away from it.
  for (const core::Object& o : workspace_.scene.objects) {
    const core::Mesh& mesh = workspace_.scene.meshOf(o);
    const auto at = [&](int corner) {
      return Vec3(o.meshToWorld *
                  core::Vec4(mesh.positions[mesh.indices[static_cast<std::size_t>(corner)]], 1));
    };
    const Vec3 a = at(0), b = at(1), c = at(2), n = glm::cross(b - a, c - a);
    core::Camera on = camera_;
    on.eye = (a + b + c) / 3.0f;
    on.up = n;
    on.at = on.eye + (b - a);
    EXPECT_TRUE(wrong.within(wrongPixels(on, {60, 45}), 0)) << o.name << ", along it";
    on.up = b - a;
    on.at = on.eye + n;
    EXPECT_TRUE(wrong.within(wrongPixels(on, {60, 45}), 0)) << o.name << ", away from it";
  }
}

TEST_F(HardViews, Hard27FieldsOfViewOfOneAnd179Degrees) {
  HardCase wrong =
      HardCase::counting("pixels at 1 and 179 degrees not as ray traced or not finite", "pixels");
  for (const float degrees : {1.0f, 179.0f}) {
    core::Camera camera = camera_;
    camera.fovYDegrees = degrees;
    EXPECT_TRUE(wrong.within(wrongPixels(camera), 0)) << degrees;
  }
}

TEST_F(HardViews, Hard21SizesFromOnePixelUp) {
  HardCase wrong = HardCase::counting("pixels of images from 1 x 1 to 513 x 2 not as ray traced", "pixels");
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{3, 5}, ImageSize{513, 2}})
    EXPECT_TRUE(wrong.within(wrongPixels(camera_, size), 0)) << size.width;
}

TEST_F(HardViews, Hard28TheConvergedImageOnAnyNumberOfThreads) {
  HardCase changed =
      HardCase::counting("converged pixels on 0, 1, 2 and 8 threads not as ray traced", "pixels");
  for (const int threads : {0, 1, 2, 8}) {
    FrameLoop loop(workspace_, *gl_.renderer, {.threads = threads});
    const core::ImageRgb image = converge(loop, camera_, {200, 150});
    EXPECT_TRUE(changed.within(
        tests::differing(image.pixels(), tests::rayTraced(workspace_, loop.frame()).pixels()), 0))
        << threads;
  }
}

}  // namespace
}  // namespace saccade
