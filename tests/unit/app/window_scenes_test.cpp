// Scenes that come and go in the window, and what a person does in one beside walking; by real events, each
// step asserted on the viewer's state and on the screen.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/viewer/kept_settings.h"
#include "core/cache_folder.h"
#include "core/image_io.h"
#include "tests/unit/app/driven_viewer.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

class WindowScenes : public ::testing::Test {
 protected:
  void SetUp() override { SACCADE_NEEDS_A_DISPLAY_TO_DRIVE(); }
  OwnFolders folders_;
};

/// A copy of a bundled scene under a name with a space and an umlaut, in the current folder.
std::filesystem::path copied(const std::string& scene, const std::string& name) {
  const std::filesystem::path copy = std::filesystem::current_path() / name;
  std::filesystem::copy_file(bundled(scene), copy, std::filesystem::copy_options::overwrite_existing);
  return copy;
}

void drop(DrivenViewer& viewer, const std::vector<std::filesystem::path>& files) {
  viewer.x().beginDrop(files, 100, 100);
  viewer.until("the drop is taken", [&] { return viewer.x().drop() == Drop::accepted; });
}

TEST_F(WindowScenes, ADroppedSceneIsOpenedBesideTheOldOne) {
  const std::filesystem::path other = copied("ward.glb", "zweiter Raum ä.glb");
  const int status = DrivenViewer::run(drivenOptions(), [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::ImageRgba8 before = viewer.picture();
    drop(viewer, {"/no/scene.txt", other});
    viewer.until("it is being opened, and says how far", [&] {
      return viewer.state().opening == other.string() && viewer.state().items.at("progress").width > 0;
    });
    EXPECT_EQ(viewer.state().scene, bundled("cornell.glb").string()) << "the old scene stays until then";
    viewer.until("it is open", [&] { return viewer.state().scene == other.string(); });
    EXPECT_TRUE(viewer.state().opening.empty());
    EXPECT_NE(viewer.state().notice.find("2 files"), std::string::npos) << viewer.state().notice;
    viewer.clickOn("notice ok");
    viewer.until("the note is gone", [&] { return viewer.state().notice.empty(); });
    viewer.frames(2);
    EXPECT_GT(pixelsThatDiffer(viewer.picture(), before), before.pixels().size() / 10);
  });
  EXPECT_EQ(status, 0);
  const app::KeptSettings kept = app::SettingsFile().load();
  ASSERT_EQ(kept.recent.size(), 2);
  EXPECT_EQ(kept.recent.front(), other);
  EXPECT_EQ(kept.recent.back(), bundled("cornell.glb"));
}

TEST_F(WindowScenes, WhatIsNoSceneIsSaidAndChangesNothing) {
  const std::filesystem::path text = std::filesystem::current_path() / "notes.txt";
  const std::filesystem::path broken = std::filesystem::current_path() / "broken.glb";
  std::ofstream(text) << "no scene";
  std::ofstream(broken) << "no scene either";
  const int status = DrivenViewer::run(drivenOptions(), [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    drop(viewer, {text});
    viewer.until("it is refused", [&] { return !viewer.state().notice.empty(); });
    EXPECT_NE(viewer.state().notice.find("notes.txt"), std::string::npos) << viewer.state().notice;
    EXPECT_TRUE(viewer.state().opening.empty());
    drop(viewer, {broken});
    viewer.until("its fault is named",
                 [&] { return viewer.state().notice.find("broken.glb") != std::string::npos; });
    viewer.frames(2);
    EXPECT_GT(viewer.state().items.at("notice").width, 0) << "on the screen";
    EXPECT_EQ(viewer.state().scene, bundled("cornell.glb").string());
    viewer.frames(3);
    viewer.clickOn("notice ok");
    viewer.until("the note is gone", [&] { return viewer.state().notice.empty(); });
    viewer.untilConverged();  // and the screen shows it
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowScenes, WhatReadingTheSceneHadToSayIsInThePanel) {
  const std::filesystem::path dark = std::filesystem::current_path() / "dark.obj";
  std::ofstream(dark) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";  // no camera, no light
  const int status = DrivenViewer::run(drivenOptions(), [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    EXPECT_EQ(viewer.state().items.at("section notes").width, 0) << "of a scene that is as it should be";
    drop(viewer, {dark});
    viewer.until("it is open", [&] { return viewer.state().scene == dark.string(); });
    viewer.frames(2);
    EXPECT_EQ(viewer.state().items.at("notes").width, 0);
    viewer.clickOn("section notes");
    viewer.until("the notes are shown", [&] { return viewer.state().items.at("notes").width > 0; });
    viewer.frames(2);
    const core::ImageRgba8 notes = viewer.control("notes");
    EXPECT_GT(notes.height(), 60) << "camera and light, two lines each at least";
    const core::Rgba8 white{255, 255, 255, 255};
    EXPECT_GT(pixelsOf(notes, white), 200u) << "letters";
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowScenes, CancelKeepsTheOldScene) {
  const std::filesystem::path other = copied("gallery.glb", "long.glb");
  const int status = DrivenViewer::run(drivenOptions(), [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    drop(viewer, {other});
    viewer.until("it is being opened", [&] { return viewer.state().items.at("cancel").width > 0; });
    viewer.frames(3);
    viewer.clickOn("cancel");
    viewer.until("it is cancelled",
                 [&] { return viewer.state().opening.empty() && !viewer.state().notice.empty(); });
    EXPECT_NE(viewer.state().notice.find("stopped on request"), std::string::npos) << viewer.state().notice;
    EXPECT_EQ(viewer.state().scene, bundled("cornell.glb").string());
  });
  EXPECT_EQ(status, 0);
}

// What OpenGL refuses is known before the old scene is let go.
TEST_F(WindowScenes, ASceneThatCannotBeUploadedKeepsTheOldOne) {
  const std::filesystem::path other = std::filesystem::current_path() / "wide.obj";
  std::ofstream(other) << "mtllib wide.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                          "f 1/1 2/2 3/3\n";
  std::ofstream("wide.mtl") << "newmtl m\nKd 1 1 1\nmap_Kd wide.png\n";
  core::writePng("wide.png", core::ImageRgba8(100000, 1));  // no context takes textures as wide
  const int status = DrivenViewer::run(drivenOptions(), [&](DrivenViewer& viewer) {
    viewer.untilOpen();
    drop(viewer, {other});
    viewer.until("the reason is shown",
                 [&] { return viewer.state().opening.empty() && !viewer.state().notice.empty(); });
    EXPECT_NE(viewer.state().notice.find("100000x1 texels"), std::string::npos) << viewer.state().notice;
    EXPECT_EQ(viewer.state().scene, bundled("cornell.glb").string());
    viewer.frames(3);
    viewer.clickOn("notice ok");
    viewer.until("the note is gone", [&] { return viewer.state().notice.empty(); });
    viewer.untilConverged();  // the old scene's pictures are as before
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowScenes, WithoutASceneTheWindowOffersRecentOnes) {
  app::SettingsFile().change([](app::KeptSettings& kept) { app::addRecent(kept, bundled("cornell.glb")); });
  app::WalkOptions options = drivenOptions();
  options.scene.path.clear();
  const int status = DrivenViewer::run(options, [](DrivenViewer& viewer) {
    viewer.until("the start screen", [&] { return viewer.state().items.at("recent 0").width > 0; });
    EXPECT_TRUE(viewer.state().scene.empty());
    viewer.frames(3);  // its window finds its size in the first ones
    viewer.clickOn("recent 0");
    viewer.until("it is open", [&] { return viewer.state().scene == bundled("cornell.glb").string(); });
    viewer.untilConverged();
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowScenes, ASceneThatCannotBeOpenedEndsWithStatusOne) {
  app::WalkOptions options = drivenOptions();
  options.scene.path = "/nowhere/room.glb";
  const int status = DrivenViewer::run(options, [](DrivenViewer& viewer) {
    viewer.until("the window says so", [&] {
      return viewer.state().notice.find("room.glb") != std::string::npos &&
             viewer.state().items.at("notice").width > 0;
    });
    EXPECT_GT(viewer.state().items.at("drop here").width, 0) << "and offers another";
  });
  EXPECT_EQ(status, 1);
}

TEST_F(WindowScenes, AClickPicksAndAttends) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.untilConverged();
    const core::FrameSnapshot& frame = viewer.state().loop->frame();
    const std::uint32_t id = largestOf(frame);
    const auto [x, y] = pixelOf(frame, id);
    const core::ImageRgba8 before = viewer.picture();
    viewer.x().click(x, y);
    viewer.until("it is picked", [&] { return viewer.state().tools->picked().has_value(); });
    EXPECT_EQ(viewer.state().tools->picked()->id, id);
    EXPECT_FALSE(viewer.state().tools->picked()->name.empty());
    EXPECT_FALSE(viewer.state().tools->picked()->material.empty());
    EXPECT_GT(viewer.state().tools->picked()->distance, 0);
    viewer.frames(3);
    const std::size_t outline = pixelsThatDiffer(viewer.picture(), before);
    EXPECT_GT(outline, 20) << "it is outlined";
    EXPECT_LT(outline, before.pixels().size() / 10) << "and nothing else changes";
    const auto analysis = viewer.state().loop->analyzer().latest();
    ASSERT_TRUE(analysis);
    ASSERT_GT(analysis->importance.attended.size(), id);
    EXPECT_GT(analysis->importance.attended[id], 0);
  });
  EXPECT_EQ(status, 0);
}

TEST_F(WindowScenes, PlacesAreKeptAndFlownTo) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    const core::Camera place = *viewer.state().camera;
    viewer.x().press("b");
    viewer.until("the place is kept", [&] { return viewer.state().tools->bookmarks().size() == 1; });
    viewer.hold("d", "away", [&] { return glm::length(viewer.state().camera->eye - place.eye) > 0.2f; });
    viewer.x().press("F2");
    viewer.until("back at the place", [&] { return viewer.state().camera->samePicture(place); });
  });
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(std::filesystem::exists(core::configFolder() / "bookmarks.json"));
}

TEST_F(WindowScenes, AWalkIsRecordedAndPlayed) {
  const int status = DrivenViewer::run(drivenOptions(), [](DrivenViewer& viewer) {
    viewer.untilOpen();
    viewer.x().press("t");
    viewer.until("it records", [&] { return viewer.state().tools->recording(); });
    const core::Vec3 start = viewer.state().camera->eye;
    viewer.hold("a", "a walk", [&] { return glm::length(viewer.state().camera->eye - start) > 0.3f; });
    const core::Vec3 end = viewer.state().camera->eye;
    viewer.x().press("t");
    viewer.until("it is saved", [&] { return !viewer.state().tools->recording(); });
    viewer.x().press("p");
    viewer.until("it plays", [&] { return viewer.state().tools->playing(); });
    viewer.until("it has played", [&] { return !viewer.state().tools->playing(); });
    EXPECT_NEAR(glm::length(viewer.state().camera->eye - end), 0, 0.15) << "where the recording ended";
  });
  EXPECT_EQ(status, 0);
  int paths = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::current_path()))
    paths += entry.path().filename().string().starts_with("saccade_path") ? 1 : 0;
  EXPECT_EQ(paths, 1);
}

}  // namespace
}  // namespace saccade::tests
