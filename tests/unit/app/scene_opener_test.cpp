// Scenes opened beside a window that stays alive.
#include "app/viewer/scene_opener.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "app/viewer/start_screen.h"
#include "core/error.h"
#include "core/scene/load.h"
#include "tests/temporary_folder.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::app {
namespace {

using std::chrono::milliseconds;

WalkOptions visitOf(const std::string& scene) {
  WalkOptions visit;
  visit.scene.path = scene;
  visit.scene.quality = "preview";
  return visit;
}

/// Patience is generous: only a fault takes so long.
template <class Condition>
bool eventually(Condition condition) {
  for (int i = 0; i < 12000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return false;
}

SceneOpener::Outcome outcomeOf(SceneOpener& opener) {
  std::optional<SceneOpener::Outcome> outcome;
  EXPECT_TRUE(eventually([&] { return (outcome = opener.take()).has_value(); }));
  return outcome ? std::move(*outcome) : SceneOpener::Outcome{};
}

/// Opens nothing: goes on until it is told to stop, and says so.
std::shared_ptr<const Workspace> openUntilStopped(const WalkOptions&, const std::stop_token& stop,
                                                  const OpeningReport& report, const SceneOpener::Drawable&) {
  report({"working", 0.25, 12});
  while (!stop.stop_requested()) std::this_thread::sleep_for(milliseconds(1));
  throw core::Error("stopped on request");
}

TEST(SceneOpener, OpensASceneAndSaysWhatItIsAt) {
  std::vector<std::string> steps;
  SceneOpener opener([&](const WalkOptions& visit, const std::stop_token& stop, const OpeningReport& report,
                         const SceneOpener::Drawable&) {
    BakeRequest bake;
    bake.file = tests::temporaryFolder() / "opened.maps";
    return openWorkspace(visit.scene, bake, stop, [&](const OpeningStep& step) {
      steps.push_back(step.what);
      EXPECT_LE(step.fraction, 1);
      report(step);
    });
  });
  EXPECT_FALSE(opener.state());
  opener.open(visitOf(SACCADE_SOURCE_DIR "/data/scenes/cornell.glb"));
  EXPECT_TRUE(opener.state());
  const SceneOpener::Outcome outcome = outcomeOf(opener);
  ASSERT_TRUE(outcome.workspace) << outcome.error;
  EXPECT_EQ(outcome.visit.scene.path, SACCADE_SOURCE_DIR "/data/scenes/cornell.glb");
  EXPECT_FALSE(outcome.workspace->maps.charts.meshes.empty());
  EXPECT_FALSE(opener.state());
  EXPECT_FALSE(opener.take()) << "each outcome is told once";
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.front(), "reading the scene");
  EXPECT_TRUE(std::any_of(steps.begin(), steps.end(),
                          [](const std::string& step) { return step.starts_with("computing its light: "); }));
}

TEST(SceneOpener, AFileThatIsNoSceneIsOneLine) {
  SceneOpener opener(
      [](const WalkOptions& visit, const std::stop_token& stop, const OpeningReport& report,
         const SceneOpener::Drawable&) { return openWorkspace(visit.scene, {}, stop, report); });
  opener.open(visitOf("/nowhere/at all.glb"));
  const SceneOpener::Outcome outcome = outcomeOf(opener);
  EXPECT_FALSE(outcome.workspace);
  EXPECT_FALSE(outcome.cancelled);
  EXPECT_NE(outcome.error.find("at all.glb"), std::string::npos) << outcome.error;
  EXPECT_EQ(outcome.error.find('\n'), std::string::npos) << outcome.error;
}

TEST(SceneOpener, CancelEndsWhatIsUnderWayWithItsReason) {
  SceneOpener opener(openUntilStopped);
  opener.open(visitOf("a.glb"));
  ASSERT_TRUE(eventually([&] { return opener.state() && opener.state()->step.what == "working"; }));
  EXPECT_EQ(opener.state()->scene, "a.glb");
  EXPECT_EQ(opener.state()->step.fraction, 0.25);
  EXPECT_EQ(opener.state()->step.secondsLeft, 12);
  opener.cancel();
  const SceneOpener::Outcome outcome = outcomeOf(opener);
  EXPECT_TRUE(outcome.cancelled);
  EXPECT_EQ(outcome.error, "a.glb: stopped on request");
  EXPECT_FALSE(opener.state());
}

// Who drops three files one after the other wants the last.
TEST(SceneOpener, TheLastSceneAskedForCounts) {
  SceneOpener opener([](const WalkOptions& visit, const std::stop_token& stop, const OpeningReport& report,
                        const SceneOpener::Drawable& drawable) -> std::shared_ptr<const Workspace> {
    if (visit.scene.path != "c.glb") return openUntilStopped(visit, stop, report, drawable);
    return std::make_unique<Workspace>();
  });
  for (const char* scene : {"a.glb", "b.glb", "c.glb"}) opener.open(visitOf(scene));
  const SceneOpener::Outcome outcome = outcomeOf(opener);
  EXPECT_EQ(outcome.visit.scene.path, "c.glb");
  EXPECT_TRUE(outcome.workspace);
  EXPECT_FALSE(opener.take());
}

TEST(SceneOpener, ASceneThatIsReadyAfterItWasCancelledIsNotShown) {
  std::atomic<bool> reading{false};
  SceneOpener opener([&](const WalkOptions&, const std::stop_token& stop, const OpeningReport&,
                         const SceneOpener::Drawable&) {
    reading = true;
    while (!stop.stop_requested()) std::this_thread::sleep_for(milliseconds(1));
    return std::make_unique<Workspace>();
  });
  opener.open(visitOf("a.glb"));
  ASSERT_TRUE(eventually([&] { return reading.load(); }));
  opener.cancel();
  const SceneOpener::Outcome outcome = outcomeOf(opener);
  EXPECT_FALSE(outcome.workspace);
  EXPECT_TRUE(outcome.cancelled);
}

// What is open but not yet taken waits for OpenGL: it can be cancelled still.
TEST(SceneOpener, AnOpenSceneThatWasNotTakenCanBeCancelled) {
  SceneOpener opener([](const WalkOptions&, const std::stop_token&, const OpeningReport&,
                        const SceneOpener::Drawable& drawable) {
    auto workspace = std::make_shared<const Workspace>();
    drawable(workspace, {});
    return workspace;
  });
  opener.open(visitOf("a.glb"));
  ASSERT_TRUE(eventually([&] { return opener.hasOutcome(); }));
  ASSERT_TRUE(opener.state());
  EXPECT_EQ(opener.state()->scene, "a.glb");
  EXPECT_TRUE(opener.drawable());
  opener.cancel();
  EXPECT_FALSE(opener.state());
  EXPECT_FALSE(opener.drawable());
  const SceneOpener::Outcome outcome = outcomeOf(opener);
  EXPECT_FALSE(outcome.workspace);
  EXPECT_TRUE(outcome.cancelled);
  EXPECT_EQ(outcome.error, "a.glb: stopped on request");
}

// The window draws the base layer while the world is built, and goes on with what it uploaded.
TEST(SceneOpener, WhatCanBeDrawnIsWhatWillBeOpened) {
  std::atomic<bool> worldIsBuilt{false};
  SceneOpener opener([&](const WalkOptions&, const std::stop_token& stop, const OpeningReport&,
                         const SceneOpener::Drawable& drawable) {
    auto workspace = std::make_shared<const Workspace>();
    drawable(workspace, {});
    while (!worldIsBuilt && !stop.stop_requested()) std::this_thread::sleep_for(milliseconds(1));
    return workspace;
  });
  EXPECT_FALSE(opener.drawable());
  opener.open(visitOf("a.glb"));
  ASSERT_TRUE(eventually([&] { return opener.drawable().has_value(); }));
  EXPECT_EQ(opener.drawable()->visit.scene.path, "a.glb");
  EXPECT_TRUE(opener.state()) << "it is not open yet";
  const std::shared_ptr<const Workspace> drawn = opener.drawable()->workspace;
  worldIsBuilt = true;
  ASSERT_TRUE(eventually([&] { return opener.hasOutcome(); }));
  EXPECT_TRUE(opener.drawable()) << "until it is taken";
  EXPECT_EQ(outcomeOf(opener).workspace, drawn);
  EXPECT_FALSE(opener.drawable());

  worldIsBuilt = false;
  opener.open(visitOf("b.glb"));
  ASSERT_TRUE(eventually([&] { return opener.drawable().has_value(); }));
  opener.cancel();
  EXPECT_FALSE(opener.drawable()) << "nobody wants to see it";
  EXPECT_TRUE(outcomeOf(opener).cancelled);
}

TEST(SceneOpener, TheEndDoesNotWaitForAScene) {
  SceneOpener opener(openUntilStopped);
  opener.open(visitOf("a.glb"));
  ASSERT_TRUE(eventually([&] { return opener.state() && opener.state()->step.what == "working"; }));
  const auto outcome = opener.end();
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->cancelled);
}

// Reading, not only baking.
TEST(SceneOpener, ReadingASceneStopsOnRequest) {
  std::stop_source stop;
  stop.request_stop();
  try {
    openWorkspace(visitOf(SACCADE_SOURCE_DIR "/data/scenes/cornell.glb").scene, {}, stop.get_token());
    FAIL() << "it was opened";
  } catch (const core::Error& e) {
    EXPECT_NE(std::string(e.what()).find("stopped on request"), std::string::npos) << e.what();
  }
}

// The last of its stages: its maps are there, its trees are not.
TEST(SceneOpener, PreparingRaysStopsOnRequest) {
  BakeRequest bake;
  bake.file = tests::temporaryFolder() / "prepared.maps";
  const SceneOptions options = visitOf(SACCADE_SOURCE_DIR "/data/scenes/cornell.glb").scene;
  openWorkspace(options, bake, {});
  const std::unique_ptr<Workspace> workspace = readWorkspace(options, bake, {});
  EXPECT_TRUE(workspace->mapsWereThere);
  EXPECT_FALSE(workspace->world);
  std::stop_source stop;
  const auto stopAtOnce = [&](const OpeningStep& step) {
    EXPECT_EQ(step.what, "preparing rays");
    stop.request_stop();
  };
  EXPECT_THROW(finishWorkspace(*workspace, stop.get_token(), stopAtOnce), core::Error);
  EXPECT_FALSE(workspace->world);
  finishWorkspace(*workspace, {});
  ASSERT_TRUE(workspace->world);
  EXPECT_TRUE(workspace->world->hasMaps());
}

TEST(DroppedScene, IsTheFirstByItsExtension) {
  const DroppedScene one = chooseDropped({"/a/Straße 1.GLB"});
  EXPECT_EQ(one.scene, "/a/Straße 1.GLB");
  EXPECT_EQ(one.message, "");
  for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.Obj"})
    EXPECT_TRUE(core::isNamedAsScene(name)) << name;
  for (const char* name : {"glb", "a.glb.png", "obj.", ""}) EXPECT_FALSE(core::isNamedAsScene(name)) << name;
  const DroppedScene several = chooseDropped({"/a/readme.txt", "/a/b.obj", "/a/c.gltf"});
  EXPECT_EQ(several.scene, "/a/b.obj");
  EXPECT_NE(several.message.find("3 files"), std::string::npos) << several.message;
  const DroppedScene none = chooseDropped({"/a/picture.png"});
  EXPECT_FALSE(none.scene);
  EXPECT_NE(none.message.find(".glb"), std::string::npos) << none.message;
  EXPECT_FALSE(chooseDropped({}).scene);
}

// What was said of the first scene does not hold for the next: its camera may not even be in it.
TEST(LaterVisit, KeepsWhatHoldsForAnyScene) {
  WalkOptions first = visitOf("first.glb");
  first.scene.mapsFile = "first.maps";
  first.scene.load.unitScale = 0.01f;
  first.camera.camera = "Camera.001";
  first.record = "walk.session";
  first.path = "path.json";
  first.corrective.delta = 0.2f;
  first.fps = 30;
  const WalkOptions later = laterVisit(first, "later.glb");
  EXPECT_EQ(later.scene.path, "later.glb");
  EXPECT_EQ(later.scene.quality, "preview");
  EXPECT_EQ(later.scene.mapsFile, "");
  EXPECT_EQ(later.scene.load.unitScale, core::LoadOptions{}.unitScale);
  EXPECT_EQ(later.camera.camera, "");
  EXPECT_EQ(later.record, "");
  EXPECT_EQ(later.path, "");
  EXPECT_EQ(later.corrective.delta, 0.2f);
  EXPECT_EQ(later.fps, 30);
}

}  // namespace
}  // namespace saccade::app
