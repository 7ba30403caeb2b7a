// View: one mapping for rasteriser and tracer.
#include "core/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/error.h"
#include "tests/hard_case.h"

namespace saccade::core {
namespace {

using tests::HardCase;

Bounds box(float half) {
  Bounds b;
  b.add(Vec3(-half));
  b.add(Vec3(half));
  return b;
}

Camera oblique() {
  Camera c;
  c.eye = {2, 1.5f, 3};
  c.at = {-0.5f, 0.3f, -1};
  c.fovYDegrees = 50;
  return c;
}

float windowDepth(const View& view, const Vec3& p) {
  const Vec4 clip = view.viewProjection() * Vec4(p, 1);
  return clip.z / clip.w;
}

TEST(View, CentreLooksAlongTheLineOfSight) {
  const View view(oblique(), 640, 480, box(5));
  const Vec3 sight = glm::normalize(oblique().at - oblique().eye);
  EXPECT_LT(glm::length(view.direction({320, 240}) - sight), 1e-6f);
}

TEST(View, RowZeroIsTheTopAndColumnsGoRight) {
  Camera c;
  c.eye = {0, 0, 0};
  c.at = {0, 0, -1};
  c.fovYDegrees = 90;
  const View view(c, 200, 100, box(5));
  const Vec3 corner = view.direction({0, 0});
  EXPECT_NEAR(corner.y, 1, 1e-6);
  EXPECT_NEAR(corner.x, -2, 1e-6);
  EXPECT_NEAR(corner.z, -1, 1e-6);
  const Vec3 centreOfFirstPixel = view.direction({0.5f, 0.5f});
  EXPECT_NEAR(centreOfFirstPixel.y, 0.99, 1e-6);
  EXPECT_NEAR(centreOfFirstPixel.x, -1.99, 1e-6);
}

/// Pixels from a random position of the image and around it, through the world and back.
void expectRoundTrip(const View& view, HardCase& lost) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-0.5f, 1.5f), unit(0, 1);
  const auto w = static_cast<float>(view.width()), h = static_cast<float>(view.height());
  for (int i = 0; i < 1000; ++i) {
    const Vec2 pixel(place(random) * w, place(random) * h);
    const float t = view.zNear() * 2 + unit(random) * 8;
    const auto back = view.project(view.camera().eye + t * view.direction(pixel));
    ASSERT_TRUE(back);
    // A point in floats is off by its own rounding and that of its offset, across and along the line of
    // sight.
    const double far = glm::length(view.direction(pixel));
    const double step = 4 * 0x1p-24 * (glm::length(view.camera().eye) + t * far);
    const double perSlope = 0.5 * h / std::tan(glm::radians(view.camera().fovYDegrees) / 2.0);
    const double allowed = perSlope * step / t * (1 + far) + 4 * 0x1p-24 * std::max(w, h);
    const Vec2 off = glm::abs(back->pixel - pixel);
    EXPECT_TRUE(lost.within(std::max(off.x, off.y), allowed)) << pixel.x << ", " << pixel.y << " at " << t;
    EXPECT_NEAR(back->viewDepth, t, step);
  }
}

TEST(View, Hard21ProjectUndoesUnprojectOfNegativeAndHalfPixels) {
  HardCase lost("pixel to the world and back, in and around images of 1 x 1 to 16384^2", "pixels");
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 5}, {333, 217}, {8192, 8192}, {16384, 16384}})
    expectRoundTrip(View(oblique(), w, h, box(6)), lost);
}

TEST(View, Hard27ProjectUndoesUnprojectAtOneAnd179Degrees) {
  HardCase narrow("pixel to the world and back at 1 degree", "pixels"),
      wide("pixel to the world and back at 179 degrees", "pixels");
  Camera c = oblique();
  c.fovYDegrees = 1;
  expectRoundTrip(View(c, 640, 480, box(6)), narrow);
  c.fovYDegrees = 179;
  expectRoundTrip(View(c, 640, 480, box(6)), wide);
}

TEST(View, ClipMatrixAgreesWithProjectAndDepth) {
  const View view(oblique(), 320, 200, box(4));
  std::mt19937 random(2);
  std::uniform_real_distribution<float> where(-4, 4);
  int seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(where(random), where(random), where(random));
    const auto projected = view.project(p);
    if (!projected) continue;
    const Vec4 clip = view.viewProjection() * Vec4(p, 1);
    ASSERT_GT(clip.w, 0);
    const float tolerance = 1e-2f / std::min(1.0f, projected->viewDepth);
    EXPECT_NEAR((clip.x / clip.w + 1) * 160, projected->pixel.x, tolerance);
    EXPECT_NEAR((clip.y / clip.w + 1) * 100, projected->pixel.y, tolerance);  // y down: no flip on read-back
    const float depth = view.viewDepth(windowDepth(view, p));
    EXPECT_NEAR(depth, projected->viewDepth, 2e-6f * projected->viewDepth + 5e-7f);  // a float's step at 4 m
    ++seen;
  }
  EXPECT_GT(seen, 300);
}

TEST(View, DepthEndsAreThePlanes) {
  const View view(oblique(), 64, 64, box(4));
  EXPECT_NEAR(view.viewDepth(1), view.zNear(), 1e-6f * view.zNear());
  EXPECT_NEAR(view.viewDepth(0), view.zFar(), 1e-6f * view.zFar());
}

TEST(View, PlanesEncloseTheSceneAtEveryScale) {
  for (const float scale : {1e-3f, 1.0f, 30.0f, 1e4f}) {
    Camera c = oblique();
    c.eye *= scale;
    c.at *= scale;
    const Bounds scene = box(2 * scale);
    const View view(c, 64, 64, scene);
    EXPECT_LT(view.zNear(), 0.01f * scale);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p(corner & 1 ? scene.hi.x : scene.lo.x, corner & 2 ? scene.hi.y : scene.lo.y,
                   corner & 4 ? scene.hi.z : scene.lo.z);
      EXPECT_LT(glm::length(p - c.eye), view.zFar());
    }
  }
}

TEST(View, NothingBehindTheEyeOrAtInfinity) {
  const View view(oblique(), 64, 64, box(4));
  const Vec3 eye = oblique().eye, sight = glm::normalize(oblique().at - eye);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(view.project(eye));
  EXPECT_FALSE(view.project(eye - sight));
  EXPECT_FALSE(view.project(eye + 0.5f * view.zNear() * sight));
  EXPECT_FALSE(view.project({nan, 0, 0}));
  EXPECT_FALSE(view.project({kInfinity, 0, 0}));
  EXPECT_TRUE(view.project(eye + sight));
}

TEST(View, ManyPointsProjectToTheBitsOfEach) {
  const View view(oblique(), 320, 200, box(4));
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(-5, 5);
  std::vector<float> x, y, z;
  for (int i = 0; i < 1003; ++i) x.push_back(u(random)), y.push_back(u(random)), z.push_back(u(random));
  x[5] = kInfinity, y[6] = std::numeric_limits<float>::quiet_NaN(), z[7] = 3e38f;
  std::vector<float> px(x.size()), py(x.size()), depth(x.size());
  view.project(x.data(), y.data(), z.data(), x.size(), px.data(), py.data(), depth.data());
  std::size_t seen = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto one = view.project({x[i], y[i], z[i]});
    const bool inside = depth[i] >= view.zNear() && depth[i] <= std::numeric_limits<float>::max() &&
                        std::isfinite(px[i]) && std::isfinite(py[i]);
    ASSERT_EQ(one.has_value(), inside) << i;
    if (!one) continue;
    ++seen;
    ASSERT_EQ(one->pixel, Vec2(px[i], py[i]));
    ASSERT_EQ(one->viewDepth, depth[i]);
  }
  EXPECT_GT(seen, 300u);
  EXPECT_LT(seen, x.size());
}

TEST(View, Hard27DegenerateCamerasAreRefused) {
  HardCase accepted =
      HardCase::counting("degenerate cameras (singular matrices) that are accepted", "cameras");
  const auto refused = [&](auto&& change) {
    Camera c = oblique();
    change(c);
    bool threw = false;
    try {
      const View view(c, 64, 64, box(1));
    } catch (const Error&) {
      threw = true;
    }
    EXPECT_TRUE(accepted.within(!threw, 0));
  };
  refused([](Camera& c) { c.at = c.eye; });
  refused([](Camera& c) { c.up = c.at - c.eye; });
  refused([](Camera& c) { c.up = -1e-3f * (c.at - c.eye); });
  refused([](Camera& c) { c.up = Vec3(0); });
  refused([](Camera& c) { c.eye.x = std::numeric_limits<float>::quiet_NaN(); });
  refused([](Camera& c) { c.at.y = kInfinity; });
  refused([](Camera& c) { c.eye = Vec3(3e38f), c.at = Vec3(-3e38f); });
  refused([](Camera& c) { c.fovYDegrees = 0; });
  refused([](Camera& c) { c.fovYDegrees = 180; });
  refused([](Camera& c) { c.fovYDegrees = -60; });
  refused([](Camera& c) { c.fovYDegrees = kInfinity; });
  EXPECT_THROW(View(oblique(), 0, 64, box(1)), Error);
}

}  // namespace
}  // namespace saccade::core
