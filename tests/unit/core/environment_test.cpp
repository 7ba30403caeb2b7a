// Environment maps: orientation, interpolation, repairs, and what a scene makes of them.
#include "core/scene/environment.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <random>

#include "core/image_io.h"
#include "core/maps.h"
#include "core/scene/load.h"
#include "core/scene/plan.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

Environment of(ImageRgb image, float degrees = 0) {
  Environment e;
  e.radiance = std::move(image);
  e.rotation = glm::radians(degrees);
  return e;
}

Environment readEnvironment(const std::filesystem::path& file, const EnvironmentOptions& options,
                            Warnings& warnings) {
  LoadBudget budget(LoadLimits{}, file.string());
  return core::readEnvironment(file, options, budget, warnings);
}

void expectNear(const Vec3& a, const Vec3& b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
}

TEST(Environment, OrientationIsAsStated) {
  const Environment e = of(ImageRgb(4, 2, Vec3(1)));
  const auto at = [&](const Vec3& d, float u, float v) {
    expectNear(Vec3(environmentUv(e, d), 0), Vec3(u, v, 0), 1e-6f);
  };
  at({0, 0, -1}, 0.5f, 0.5f);   // the middle lies ahead
  at({1, 0, 0}, 0.75f, 0.5f);   // its right quarter to the right
  at({-3, 0, 0}, 0.25f, 0.5f);  // any length
  EXPECT_EQ(environmentUv(e, {0, 1, 0}).y, 0);
  EXPECT_NEAR(environmentUv(e, {0, -1, 0}).y, 1, 1e-6);
  // Counter-clockwise seen from above: what lay ahead (-Z) lies to the left (-X).
  const Environment turned = of(ImageRgb(4, 2, Vec3(1)), 90);
  EXPECT_NEAR(environmentUv(turned, {-1, 0, 0}).x, 0.5f, 1e-6);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(environmentUv(e, Vec3(nan)), Vec2(0));
  EXPECT_EQ(environmentRadiance(e, Vec3(nan)), Vec3(1));
}

TEST(Environment, DirectionsAndPlacesAreInverse) {
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  for (const float degrees : {0.0f, 37.0f, -300.0f}) {
    const Environment e = of(ImageRgb(4, 2), degrees);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 d = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
      const Vec2 uv = environmentUv(e, d);
      ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
      expectNear(environmentDirection(e, uv), d, 2e-6f);
    }
  }
}

TEST(Environment, InterpolatesAcrossTheSeamAndHoldsAtThePoles) {
  ImageRgb image(4, 2);
  for (int x = 0; x < 4; ++x) {
    image.at(x, 0) = Vec3(static_cast<float>(x));
    image.at(x, 1) = Vec3(10);
  }
  const Environment e = of(image);
  const auto at = [&](float u, float v) { return environmentRadiance(e, environmentDirection(e, {u, v})).x; };
  EXPECT_NEAR(at(0.375f, 0.25f), 1, 1e-5);  // a texel's centre
  EXPECT_NEAR(at(0.5f, 0.25f), 1.5, 1e-5);
  EXPECT_NEAR(at(0.0f, 0.25f), 1.5, 1e-5);   // between the last column and the first
  EXPECT_NEAR(at(0.375f, 0.1f), 1, 1e-5);    // above the first row's centres
  EXPECT_NEAR(at(0.375f, 0.5f), 5.5, 1e-5);  // between the rows
  EXPECT_NEAR(at(0.375f, 0.95f), 10, 1e-5);
}

TEST(Environment, ReadsExrAndHdrByContentAndRepairs) {
  const tests::TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ImageRgb image(4, 2, Vec3(2));
  image.at(0, 0) = Vec3(nan, 3, 4);
  image.at(1, 0) = Vec3(-1, 3, 4);
  image.at(2, 0) = Vec3(kInfinity, 3, 4);
  writeExr(folder / "a.exr", image);
  Warnings warnings;
  const Environment e = readEnvironment(folder / "a.exr", {.rotationDegrees = 450, .scale = 0.5f}, warnings);
  EXPECT_NEAR(e.rotation, glm::radians(90.0f), 1e-6);
  EXPECT_EQ(e.radiance.at(0, 0), Vec3(0, 1.5f, 2));
  EXPECT_EQ(e.radiance.at(1, 0), Vec3(0, 1.5f, 2));
  EXPECT_EQ(e.radiance.at(2, 0), Vec3(kLargestEnvironmentRadiance, 1.5f, 2));
  EXPECT_EQ(e.radiance.at(3, 1), Vec3(1));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(": 3 texels"), std::string::npos) << warnings[0];

  warnings.clear();
  std::ofstream(folder / "b.exr", std::ios::binary) << "#?RADIANCE\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
  EXPECT_EQ(readEnvironment(folder / "b.exr", {}, warnings).radiance.at(0, 0), Vec3(1));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("stretched"), std::string::npos) << warnings[0];
}

TEST(Environment, RefusesNamingFileAndRule) {
  const tests::TemporaryFolder folder;
  Warnings warnings;
  const auto refused = [&](const std::string& name, const char* why, const EnvironmentOptions& options = {}) {
    try {
      readEnvironment(folder / name, options, warnings);
      ADD_FAILURE() << name << " was read";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  refused("nowhere.exr", "no such file");
  std::filesystem::create_directories(folder / "folder.hdr");
  refused("folder.hdr", "not a regular file");
  std::ofstream(folder / "text.exr") << "not a picture";
  refused("text.exr", "OpenEXR (.exr) or Radiance (.hdr)");
  std::ofstream(folder / "empty.exr");
  refused("empty.exr", "OpenEXR (.exr) or Radiance (.hdr)");
  writeExr(folder / "good.exr", ImageRgb(2, 1));
  refused("good.exr", "--environment-scale", {.scale = -1});
  refused("good.exr", "--environment-rotation", {.rotationDegrees = kInfinity});
}

/// One white square without a light.
void writeSquare(const std::filesystem::path& file) {
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 4 3 2 1\n";
}

TEST(Environment, TakesTheDefaultLightsPlaceAndBelongsToTheKey) {
  const tests::TemporaryFolder folder;
  writeSquare(folder / "square.obj");
  writeExr(folder / "sky.exr", ImageRgb(4, 2, Vec3(1)));
  LoadOptions options;
  const Scene plain = loadScene(folder / "square.obj", options);
  EXPECT_TRUE(plain.defaultLight);
  options.environment = folder / "sky.exr";
  const Scene lit = loadScene(folder / "square.obj", options);
  EXPECT_FALSE(lit.defaultLight);
  ASSERT_TRUE(lit.environment);
  options.environmentOptions.rotationDegrees = 1;
  const Scene turned = loadScene(folder / "square.obj", options);
  options.environmentOptions = {.scale = 2};
  const Scene bright = loadScene(folder / "square.obj", options);
  EXPECT_NE(sceneKey(lit), sceneKey(plain));
  EXPECT_NE(sceneKey(lit), sceneKey(turned));
  EXPECT_NE(sceneKey(lit), sceneKey(bright));
  EXPECT_EQ(sceneKey(lit), sceneKey(Scene(lit)));
  bool named = false;
  for (const PlanLine& line : makePlan(lit).lines)
    named =
        named || (line.stage == "environment" && line.on && line.reason.find("sky.exr") != std::string::npos);
  EXPECT_TRUE(named);
}

}  // namespace
}  // namespace saccade::core
