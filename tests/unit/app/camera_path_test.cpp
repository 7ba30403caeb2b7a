#include "app/session/camera_path.h"

#include <gtest/gtest.h>

#include <fstream>

#include "app/viewer/walker.h"
#include "core/error.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::app {
namespace {

std::filesystem::path fileWith(const std::string& text) {
  const std::filesystem::path file = tests::temporaryFolder() / "path.json";
  std::ofstream(file) << text;
  return file;
}

TEST(CameraPath, PassesThroughItsKeysExactlyAndRestsAtItsEnds) {
  const CameraPath path = CameraPath::read(fileWith(R"([
    {"t": 0, "eye": [0,1,2], "at": [0,1,0], "fov": 50}, {"t": 1.5, "eye": [1,1,2], "at": [0,1,0]},
    {"t": 4, "eye": [3,2,1], "at": [1,0,0], "up": [0,1,0], "fov": 40}])"));
  EXPECT_EQ(path.lengthSeconds(), 4);
  EXPECT_EQ(path.at(1.5).eye, core::Vec3(1, 1, 2));
  EXPECT_EQ(path.at(-1).eye, core::Vec3(0, 1, 2));
  EXPECT_TRUE(path.at(9).samePicture(path.at(4)));
  EXPECT_EQ(path.at(9).fovYDegrees, 40);
  EXPECT_EQ(path.at(1.5).fovYDegrees, 60);  // the default
}

TEST(CameraPath, AStraightEvenPathStaysStraightAndEven) {
  const CameraPath path = CameraPath::read(fileWith(R"([
    {"t": 0, "eye": [0,0,5], "at": [0,0,0]}, {"t": 1, "eye": [1,0,5], "at": [1,0,0]},
    {"t": 2, "eye": [2,0,5], "at": [2,0,0]}, {"t": 3, "eye": [3,0,5], "at": [3,0,0]}])"));
  for (double t = 1; t <= 2; t += 0.125) EXPECT_NEAR(path.at(t).eye.x, t, 1e-6);
}

TEST(CameraPath, AnOrbitKeepsItsRadiusAndComesBack) {
  core::Camera camera;
  camera.eye = {0, 1.6f, 3};
  camera.at = {0, 1, 0};
  const CameraPath path = CameraPath::orbit(camera, 12);
  EXPECT_TRUE(path.at(0).samePicture(camera));
  EXPECT_TRUE(path.at(12).samePicture(camera));
  for (double t = 0; t < 12; t += 0.1) {
    const core::Camera c = path.at(t);
    EXPECT_NEAR(glm::length(core::Vec2(c.eye.x, c.eye.z)), 3, 3e-4);
    EXPECT_FLOAT_EQ(c.eye.y, 1.6f);
  }
}

TEST(CameraPath, BadFilesAreRefusedNamingTheKey) {
  for (const char* text :
       {"", "{", "{}", "[]", "[1]", R"([{"t":0,"eye":[0,0],"at":[0,0,1]}])",
        R"([{"t":0,"eye":[0,0,0],"at":[0,0,0]}])", R"([{"t":0,"eye":[0,0,1],"at":[0,0,0],"fov":180}])",
        R"([{"eye":[0,0,1],"at":[0,0,0]}])", R"([{"t":1e999,"eye":[0,0,1],"at":[0,0,0]}])",
        R"([{"t":1,"eye":[0,0,1],"at":[0,0,0]},{"t":1,"eye":[0,0,1],"at":[0,0,0]}])"}) {
    EXPECT_THROW(CameraPath::read(fileWith(text)), core::Error) << text;
  }
  EXPECT_THROW(CameraPath::read("/no/such/file.json"), core::Error);
}

TEST(Walker, TurningByAFullCircleComesBack) {
  core::Camera camera;
  camera.eye = {1, 2, 3};
  camera.at = {1, 2, 2};
  Walker walker(camera, 20);
  const float pixels = 2 * core::kPi / 0.003f;
  for (int i = 0; i < 8; ++i) walker.look(pixels / 8, 0);
  EXPECT_NEAR(glm::length(glm::normalize(walker.camera().at - walker.camera().eye) - core::Vec3(0, 0, -1)), 0,
              1e-4);
  EXPECT_EQ(walker.camera().eye, camera.eye);
}

TEST(Walker, WalksWhereItLooksAtAPersonsPace) {
  core::Camera camera;
  camera.eye = {0, 1.6f, 0};
  camera.at = {1, 1.6f, 0};
  Walker walker(camera, 20);
  walker.move({.forward = 1}, 2);
  EXPECT_NEAR(walker.camera().eye.x, 2.8f, 1e-4);
  EXPECT_NEAR(walker.camera().eye.z, 0, 1e-4);
  walker.move({.right = 1}, 1);
  EXPECT_NEAR(walker.camera().eye.z, 1.4f, 1e-4);
  walker.look(0, 1e6f);  // straight down at most
  EXPECT_LT(walker.camera().at.y, walker.camera().eye.y);
  EXPECT_GT(glm::length(glm::cross(walker.camera().at - walker.camera().eye, walker.camera().up)), 1e-3f);
}

}  // namespace
}  // namespace saccade::app
