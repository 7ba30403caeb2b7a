// Flights, recorded paths, places and the bars of frame time, without a window.
#include "app/viewer/scene_tools.h"

#include <cmath>
#include <fstream>

#include "app/viewer/stage_bars.h"
#include "app/viewer/walker.h"
#include "core/error.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::app {
namespace {

core::Camera cameraAt(const core::Vec3& eye, const core::Vec3& at, float fov = 60) {
  core::Camera camera;
  camera.eye = eye;
  camera.at = at;
  camera.fovYDegrees = fov;
  return camera;
}

/// A walk as keys and mouse make it: stops, turns, a zoom; `jitter` in seconds moves the frames' times.
std::vector<CameraKey> recordedWalk(double jitter = 0) {
  Walker walker(cameraAt({0, 1.6f, 0}, {0, 1.6f, -1}), 20);
  std::vector<CameraKey> recorded;
  for (int i = 0; i < 750; ++i) {
    const float dt = 0.04f;
    if (i > 50 && i < 300) walker.move({.forward = 1, .right = i > 200 ? 1.0f : 0.0f}, dt);
    if (i > 120 && i < 360) walker.look(4 * std::sin(0.05f * static_cast<float>(i)), 1);
    if (i > 500 && i < 520) walker.zoom(0.2f);
    if (i > 600) walker.move({.forward = -1, .up = 1}, dt);
    recorded.push_back({0.04 * i + jitter * std::sin(1.7 * i), walker.camera()});
  }
  return recorded;
}

TEST(RecordedPath, PlaysWithinTheToleranceOfWhatWasRecorded) {
  const PathTolerance tolerance;
  for (const double jitter : {0.0, 0.003}) {
    const std::vector<CameraKey> recorded = recordedWalk(jitter);
    const std::vector<CameraKey> keys = thinned(recorded, tolerance);
    EXPECT_LT(keys.size(), recorded.size() / 4);
    EXPECT_TRUE(keys.front().camera.samePicture(recorded.front().camera));
    EXPECT_TRUE(keys.back().camera.samePicture(recorded.back().camera));
    const std::filesystem::path file = tests::temporaryFolder() / "walk.json";
    writeCameraPath(file, keys);
    const CameraPath path = CameraPath::read(file);
    for (const CameraKey& key : recorded) {
      EXPECT_TRUE(within(tolerance, path.at(key.seconds), key.camera)) << key.seconds;
    }
  }
}

TEST(RecordedPath, IsReadBackToTheLastBit) {
  const std::vector<CameraKey> recorded = recordedWalk();
  const std::filesystem::path file = tests::temporaryFolder() / "all.json";
  writeCameraPath(file, recorded);
  const std::vector<CameraKey> read = CameraPath::read(file).keys();
  ASSERT_EQ(read.size(), recorded.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].seconds, recorded[i].seconds);
    EXPECT_TRUE(read[i].camera.samePicture(recorded[i].camera));
  }
  EXPECT_THROW(writeCameraPath("/no/such/folder/path.json", recorded), core::Error);
}

TEST(RecordedPath, WhatStandsStillOrIsShortNeedsTwoKeys) {
  std::vector<CameraKey> still;
  for (int i = 0; i < 100; ++i) still.push_back({0.1 * i, cameraAt({1, 2, 3}, {0, 0, 0})});
  EXPECT_EQ(thinned(still, {}).size(), 2u);
  still.resize(1);
  EXPECT_EQ(thinned(still, {}).size(), 1u);
  EXPECT_TRUE(thinned({}, {}).empty());
}

TEST(RecordedPath, ALooserToleranceNeedsNoMoreKeys) {
  const std::vector<CameraKey> recorded = recordedWalk();
  const auto keys = [&](float times) {
    return thinned(recorded, {0.01f * times, 0.005f * times, 0.1f * times}).size();
  };
  EXPECT_GT(keys(0.1f), keys(1));
  EXPECT_GT(keys(1), keys(10));
}

/// Speed of the eye at a time, by differences.
template <class Motion>
core::Vec3 velocity(const Motion& motion, double t, double h = 1e-3) {
  return (motion.at(t + h).eye - motion.at(t - h).eye) / static_cast<float>(2 * h);
}

TEST(Playback, HasNoJumpOfSpeedAtItsKeys) {
  const CameraPath path = CameraPath::through(thinned(recordedWalk(), {}));
  for (const CameraKey& key : path.keys()) {
    if (key.seconds <= 0 || key.seconds >= path.lengthSeconds()) continue;
    // From one side to the other; of a jump as much is left however near one looks.
    const auto change = [&](double h) {
      return glm::length(velocity(path, key.seconds + h, h) - velocity(path, key.seconds - h, h));
    };
    EXPECT_LT(change(1e-3), 0.4f * change(4e-3) + 0.01f) << "at " << key.seconds;
  }
}

TEST(Flight, LeavesAndArrivesAtRestExactlyAndTheShortWayRound) {
  const core::Camera from = cameraAt({0, 1.6f, 5}, {0.1f, 1.6f, 6}, 50);  // looks back, a little right
  const core::Camera to = cameraAt({3, 2.0f, 1}, {2.9f, 1.5f, 2}, 70);    // back, a little left
  const Flight flight(from, to, 20);
  EXPECT_TRUE(flight.at(0).samePicture(from));
  EXPECT_TRUE(flight.at(flight.seconds()).samePicture(to));
  EXPECT_LT(glm::length(velocity(flight, 2e-3)), 0.1f);
  EXPECT_LT(glm::length(velocity(flight, flight.seconds() - 2e-3)), 0.1f);
  EXPECT_GT(glm::length(velocity(flight, flight.seconds() / 2)), 1);
  for (double t = 0; t <= flight.seconds(); t += 0.01) {
    const core::Camera c = flight.at(t);
    EXPECT_GT(glm::normalize(c.at - c.eye).z, 0.8f) << "does not turn through the front";
    EXPECT_NO_THROW(core::View(c, 8, 8, {core::Vec3(-9), core::Vec3(9)}));
  }
}

TEST(CameraDrive, FliesToAPathPlaysItAndComesBackInALoop) {
  const core::Camera here = cameraAt({5, 1, 0}, {5, 1, -1});
  const CameraPath path = CameraPath::through({{1, cameraAt({0, 1, 0}, {0, 1, -1})},
                                               {2, cameraAt({1, 1, 0}, {1, 1, -1})},
                                               {3, cameraAt({1, 1, 2}, {1, 1, 1})}});
  CameraDrive drive(10);
  EXPECT_FALSE(drive.at(0));
  drive.setLoop(true);
  drive.play(path, here, 100);
  EXPECT_TRUE(drive.at(100)->samePicture(here));
  bool began = false, ended = false, again = false;
  std::optional<core::Camera> last;
  for (double t = 100; t < 112; t += 1.0 / 64) {
    const auto camera = drive.at(t);
    ASSERT_TRUE(camera);
    if (last) {
      EXPECT_LT(glm::length(camera->eye - last->eye), 0.2f) << "no jump at " << t;
    }
    last = camera;
    const bool first = camera->samePicture(path.at(1)), lastKey = camera->samePicture(path.at(3));
    again |= ended && first;
    began |= first;
    ended |= began && lastKey;
  }
  EXPECT_TRUE(began && ended && again);
  drive.setLoop(false);
  for (double t = 112; t < 120; t += 0.1) last = drive.at(t) ? drive.at(t) : last;
  EXPECT_FALSE(drive.moving());
  drive.play(path, 0);
  EXPECT_TRUE(drive.at(0)->samePicture(path.at(1))) << "at once";
  drive.stop();
  EXPECT_FALSE(drive.at(0.1));
}

class BookmarkFile : public testing::Test {
 protected:
  std::filesystem::path folder_ = tests::temporaryFolder() / "bookmarks";
  std::filesystem::path file_ = folder_ / "bookmarks.json";
  void SetUp() override { std::filesystem::remove_all(folder_); }
};

TEST_F(BookmarkFile, KeepsPlacesByScene) {
  const core::Camera a = cameraAt({0.1f, 1.6f, 3}, {0, 1, 1e-7f}, 47.3f), b = cameraAt({1, 2, 3}, {4, 5, 6});
  {
    Bookmarks one(file_, "one.glb"), two(file_, "two.glb");  // two windows
    one.add(a);
    two.add(b);
    one.add(b);
    one.set(1, a);
  }
  Bookmarks one(file_, "./one.glb");
  ASSERT_EQ(one.all().size(), 2u);
  EXPECT_TRUE(one.all()[0].samePicture(a));
  EXPECT_TRUE(one.all()[1].samePicture(a));
  EXPECT_EQ(one.all()[1].name, "place 2");
  one.remove(0);
  one.add(b);
  EXPECT_EQ(one.all()[1].name, "place 3") << "a name that is not taken";
  EXPECT_EQ(Bookmarks(file_, "two.glb").all().size(), 1u);
  EXPECT_TRUE(Bookmarks(file_, "three.glb").all().empty());
}

TEST_F(BookmarkFile, DamagedOnesAreRefusedAndLeftAlone) {
  std::filesystem::create_directories(folder_);
  const std::string scene = std::filesystem::weakly_canonical(std::filesystem::absolute("one.glb")).string();
  for (const std::string& text :
       {std::string("{"), std::string("[]"), std::string(R"({"version":2,"scenes":{}})"),
        R"({"version":1,"scenes":{")" + scene + R"(":[{"name":"x"}]}})",
        R"({"version":1,"scenes":{")" + scene +
            R"(":[{"name":"x","eye":[0,0,0],"at":[0,0,0],"up":[0,1,0],"fov":60}]}})"}) {
    std::ofstream(file_) << text;
    EXPECT_THROW(Bookmarks(file_, "one.glb"), core::Error) << text;
  }
}

TEST_F(BookmarkFile, ToolsSayWhatFailsAndGoOn) {
  const char* before = std::getenv("XDG_CONFIG_HOME");
  const std::string kept = before ? before : "";
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "saccade") << "a file where the folder should be";
  setenv("XDG_CONFIG_HOME", folder_.c_str(), 1);
  core::Scene scene;
  scene.path = "scene.glb";
  scene.bounds = {core::Vec3(-5), core::Vec3(5)};
  SceneTools tools(scene);
  tools.takeMessage();
  ToolRequests keep;
  keep.addBookmark = true;
  tools.serve(keep, cameraAt({1, 2, 3}, {0, 0, 0}), 0);
  EXPECT_NE(tools.takeMessage().find("bookmarks.json"), std::string::npos);
  ToolRequests goTo;
  goTo.goTo = 0;  // kept for this visit all the same
  tools.serve(goTo, cameraAt({0, 0, 0}, {0, 0, -1}), 1);
  EXPECT_TRUE(tools.camera(10)->samePicture(cameraAt({1, 2, 3}, {0, 0, 0})));
  if (before) {
    setenv("XDG_CONFIG_HOME", kept.c_str(), 1);
  } else {
    unsetenv("XDG_CONFIG_HOME");
  }
}

TEST_F(BookmarkFile, ARecordedPathIsSavedUnderAFreeNameAndPlayed) {
  std::filesystem::create_directories(folder_);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  core::Scene scene;
  scene.bounds = {core::Vec3(-5), core::Vec3(5)};
  SceneTools tools(scene);
  tools.takeMessage();
  ToolRequests record, play;
  record.recordPath = true;
  play.playPath = true;
  tools.serve(play, {}, 0);
  EXPECT_NE(tools.takeMessage().find("no path yet"), std::string::npos);
  for (int take = 1; take <= 2; ++take) {
    tools.serve(record, {}, 0);
    EXPECT_TRUE(tools.recording());
    for (const CameraKey& key : recordedWalk()) tools.observe(key.camera, key.seconds);
    tools.serve(record, {}, 40);
    EXPECT_NE(tools.takeMessage().find("saccade_path_000" + std::to_string(take) + ".json"),
              std::string::npos);
  }
  const CameraPath path = CameraPath::read("saccade_path_0002.json");
  std::filesystem::current_path(before);
  EXPECT_EQ(path.lengthSeconds(), recordedWalk().back().seconds);
  tools.serve(play, recordedWalk().back().camera, 50);
  EXPECT_TRUE(tools.playing());
  EXPECT_TRUE(tools.camera(50)->samePicture(recordedWalk().back().camera));
  tools.release();
  EXPECT_FALSE(tools.camera(51));
}

TEST(Keys, AskForPlacesAndPaths) {
  using render::Key;
  ToolRequests wanted;
  request(Key::f2, false, wanted);
  request(Key::f9, true, wanted);
  request(Key::t, false, wanted);
  EXPECT_EQ(wanted.goTo, 0u);
  EXPECT_EQ(wanted.setBookmark, 7u);
  EXPECT_TRUE(wanted.recordPath);
  EXPECT_FALSE(wanted.playPath || wanted.addBookmark || wanted.removeBookmark);
  ToolRequests nothing;
  for (const Key key : {Key::f1, Key::f10, Key::f11, Key::f12, Key::w}) request(key, false, nothing);
  EXPECT_FALSE(nothing.goTo || nothing.setBookmark || nothing.recordPath);
}

TEST(StageTimes, PartsOfAFrameSumToItsTime) {
  StageTimes times;
  std::map<std::string, double> sums{{"draw", 5}, {"correct", 20}, {"something new", 1}};
  times.add(&sums, 3, 40);
  sums["draw"] += 7;
  times.add(&sums, 2, 12);
  sums["draw"] += 100;  // more than the frame: cut
  times.add(&sums, 2, 12);
  times.add(nullptr, 1, 4);
  const std::map<std::string, double> another{{"draw", 2}};
  times.add(&another, 0, 3);  // a new scene's sums begin again
  for (const StageTimes::Frame& frame : times.frames()) {
    double sum = 0;
    for (const float part : frame.partMs) {
      EXPECT_GE(part, 0);
      sum += static_cast<double>(part);
    }
    EXPECT_NEAR(sum, frame.totalMs, 1e-5 * frame.totalMs);
  }
  const auto part = [&](std::size_t frame, const std::string& stage) {
    const auto found = std::find(times.stages().begin(), times.stages().end(), stage);
    return times.frames()[frame].partMs.at(static_cast<std::size_t>(found - times.stages().begin()));
  };
  EXPECT_EQ(part(0, "draw"), 5);
  EXPECT_EQ(part(0, "something new"), 1);
  EXPECT_EQ(part(0, StageTimes::kRest), 11);
  EXPECT_EQ(part(1, "draw"), 7);
  EXPECT_EQ(part(1, "correct"), 0);
  EXPECT_EQ(part(4, "draw"), 2);
  for (std::size_t i = 0; i < 2 * StageTimes::kShown; ++i) times.add(&another, 0, 3);
  EXPECT_EQ(times.frames().size(), StageTimes::kShown);
  EXPECT_DOUBLE_EQ(times.meanMs(), 3);
}

}  // namespace
}  // namespace saccade::app
