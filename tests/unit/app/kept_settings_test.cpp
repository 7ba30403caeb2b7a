// What the window keeps between runs.
#include "app/viewer/kept_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "tests/unit/core/temporary_folder.h"

namespace saccade::app {
namespace {

class KeptSettingsFile : public testing::Test {
 protected:
  KeptSettingsFile() {
    if (const char* before = std::getenv("XDG_CONFIG_HOME")) before_ = before;
    ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
    std::filesystem::create_directories(file_.parent_path());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
  }
  ~KeptSettingsFile() override {
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    if (before_) {
      ::setenv("XDG_CONFIG_HOME", before_->c_str(), 1);
    } else {
      ::unsetenv("XDG_CONFIG_HOME");
    }
  }

  /// What is read where the file holds this text, and in said_ the warnings.
  KeptSettings load(const std::string& text) {
    std::ofstream(file_) << text;
    forget();
    return SettingsFile().load();
  }
  /// Keeps these instead of what was kept.
  static void save(const KeptSettings& settings) {
    SettingsFile().change([&](KeptSettings& kept) { kept = settings; });
  }
  std::ptrdiff_t warnings() {
    hear();
    return std::count(said_.begin(), said_.end(), '\n');
  }
  void forget() {
    hear();
    said_.clear();
  }
  static std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path scene(const std::string& name) {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream(file) << "scene";
    return file;
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "saccade" / "settings.json";
  std::string said_;  ///< warnings, wherever the log goes

 private:
  void hear() {
    said_ += testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
  }

  std::optional<std::string> before_;
};

TEST_F(KeptSettingsFile, AllComesBack) {
  KeptSettings kept;
  kept.window = ImageSize{1000, 700};
  kept.fullscreen = true;
  kept.panelVisible = false;
  kept.errorPlotOpen = false;
  kept.corrections = true;
  kept.reuse = false;
  kept.approximation = true;
  kept.attention = 0.1;
  kept.fps = 30;
  kept.exposureEv = -1.5;
  kept.delta = 0.3;
  addRecent(kept, scene("a.glb"));
  save(kept);
  const KeptSettings back = SettingsFile().load();
  ASSERT_TRUE(back.window);
  EXPECT_EQ(back.window->width, 1000);
  EXPECT_EQ(back.window->height, 700);
  EXPECT_EQ(back.fullscreen, kept.fullscreen);
  EXPECT_EQ(back.panelVisible, kept.panelVisible);
  EXPECT_EQ(back.errorPlotOpen, kept.errorPlotOpen);
  EXPECT_EQ(back.corrections, kept.corrections);
  EXPECT_EQ(back.reuse, kept.reuse);
  EXPECT_EQ(back.approximation, kept.approximation);
  EXPECT_EQ(back.attention, kept.attention);
  EXPECT_EQ(back.fps, kept.fps);
  EXPECT_EQ(back.exposureEv, kept.exposureEv);
  EXPECT_EQ(back.delta, kept.delta);
  EXPECT_EQ(back.recent, kept.recent);
  EXPECT_EQ(warnings(), 0) << said_;
}

TEST_F(KeptSettingsFile, NothingChangedIsNothingKept) {
  EXPECT_FALSE(SettingsFile().load().attention);
  save({});
  const KeptSettings back = SettingsFile().load();
  EXPECT_FALSE(back.window || back.fullscreen || back.panelVisible || back.errorPlotOpen ||
               back.corrections || back.reuse || back.attention || back.fps || back.exposureEv || back.delta);
  EXPECT_TRUE(back.recent.empty());
  EXPECT_EQ(warnings(), 0) << said_;
}

TEST_F(KeptSettingsFile, ForeignAndDamagedOnesAreOneWarning) {
  for (const char* text : {"", "{", "[]", "null", "7", "{}", R"({"version": 2, "fps": 30})",
                           R"({"version": "1"})", R"({"version": 1, "fps": 1e999})", "\xff\xfe\0"}) {
    EXPECT_FALSE(load(text).fps) << text;
    EXPECT_EQ(warnings(), 1) << text << ": " << said_;
    EXPECT_NE(said_.find(file_.string()), std::string::npos) << text;
  }
}

TEST_F(KeptSettingsFile, WrongValuesAreLeftOutAndNamedOnce) {
  const KeptSettings kept = load(R"({"version": 1, "attention": 1.5, "fps": 0, "exposure": null,
      "delta": "0.1", "panel": 0, "reuse": false, "window": [100, 0], "recent": {}, "corrections": true})");
  EXPECT_FALSE(kept.attention || kept.fps || kept.exposureEv || kept.delta || kept.panelVisible ||
               kept.window);
  EXPECT_EQ(kept.reuse, false);
  EXPECT_EQ(kept.corrections, true);
  EXPECT_EQ(warnings(), 1) << said_;
  for (const char* name : {"attention", "fps", "exposure", "delta", "panel", "window", "recent"})
    EXPECT_NE(said_.find(name), std::string::npos) << name;
  EXPECT_EQ(said_.find("corrections"), std::string::npos);
  for (const char* window :
       {"[1]", "[1, 2, 3]", "[1.5, 2]", "[40000, 5]", "[1e300, 5]", "\"1x1\"", "[[], 1]"}) {
    EXPECT_FALSE(load(std::string(R"({"version": 1, "window": )") + window + "}").window) << window;
    EXPECT_EQ(warnings(), 1) << window;
  }
}

TEST_F(KeptSettingsFile, RecentScenesAreNewestFirstWithoutRepeats) {
  KeptSettings kept;
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < 12; ++i) files.push_back(scene(std::to_string(i) + ".glb"));
  for (const std::filesystem::path& file : files) addRecent(kept, file);
  ASSERT_EQ(kept.recent.size(), kMostRecent);
  EXPECT_EQ(kept.recent.front(), files[11]);
  EXPECT_EQ(kept.recent.back(), files[2]);
  addRecent(kept, files[5].parent_path() / "." / files[5].filename());
  EXPECT_EQ(kept.recent.front(), files[5]);
  EXPECT_EQ(std::count(kept.recent.begin(), kept.recent.end(), files[5]), 1);
  save(kept);
  std::filesystem::remove(files[7]);
  std::erase(kept.recent, files[7]);
  EXPECT_EQ(SettingsFile().load().recent, kept.recent);
  EXPECT_EQ(warnings(), 0) << said_;
  addRecent(kept, "somewhere.glb");
  EXPECT_EQ(kept.recent.front(), std::filesystem::current_path() / "somewhere.glb");
}

TEST_F(KeptSettingsFile, ANameThatIsNoTextIsLeftOut) {
  KeptSettings kept;
  addRecent(kept, scene("\xff.glb"));
  addRecent(kept, scene("good.glb"));
  save(kept);
  const KeptSettings back = SettingsFile().load();
  ASSERT_EQ(back.recent.size(), 1u);
  EXPECT_EQ(back.recent.front().filename(), "good.glb");
}

TEST_F(KeptSettingsFile, AFolderThatCannotBeWrittenIsOneWarning) {
  std::filesystem::remove_all(file_.parent_path());
  std::ofstream(file_.parent_path()) << "no folder";
  SettingsFile file;
  for (const double fps : {20.0, 30.0, 40.0}) file.change([&](KeptSettings& kept) { kept.fps = fps; });
  EXPECT_EQ(warnings(), 1) << said_;
  EXPECT_NE(said_.find("not kept"), std::string::npos) << said_;
}

TEST_F(KeptSettingsFile, AFolderOfTheFilesNameIsOneWarningAndMovesAside) {
  std::filesystem::create_directories(file_);
  EXPECT_FALSE(SettingsFile().load().fps);
  EXPECT_EQ(warnings(), 1) << said_;
  SettingsFile().change([](KeptSettings& kept) { kept.fps = 30; });
  EXPECT_EQ(SettingsFile().load().fps, 30);
  EXPECT_EQ(warnings(), 1) << said_;
}

TEST_F(KeptSettingsFile, WithoutAPlaceThereIsOneWarning) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  ::setenv("XDG_CONFIG_HOME", "", 1);
  ::unsetenv("HOME");
  SettingsFile file;
  ::setenv("HOME", home.c_str(), 1);
  EXPECT_FALSE(file.load().fps);
  for (const double fps : {20.0, 30.0}) file.change([&](KeptSettings& kept) { kept.fps = fps; });
  EXPECT_EQ(warnings(), 1) << said_;
}

TEST_F(KeptSettingsFile, WhatChangesNothingWritesNothing) {
  SettingsFile().change([](KeptSettings&) {});
  EXPECT_FALSE(std::filesystem::exists(file_));
  load("{");
  SettingsFile().change([](KeptSettings&) {});
  EXPECT_EQ(textOf(file_), "{");
}

TEST_F(KeptSettingsFile, ChangesLeaveWhatAnotherWindowKept) {
  KeptSettings kept;
  kept.fps = 50;
  addRecent(kept, scene("one.glb"));
  save(kept);
  const KeptSettings start = SettingsFile().load();
  SettingsFile().change([&](KeptSettings& other) {
    other.attention = 0.25;
    other.reuse = false;
    addRecent(other, scene("two.glb"));
  });
  SettingsFile().change([](KeptSettings& now) { now.fps = 30; });
  const KeptSettings end = SettingsFile().load();
  EXPECT_EQ(start.fps, 50);
  EXPECT_EQ(end.fps, 30);
  EXPECT_EQ(end.attention, 0.25);
  EXPECT_EQ(end.reuse, false);
  ASSERT_EQ(end.recent.size(), 2u);
  EXPECT_EQ(end.recent[0], scene("two.glb"));
}

TEST_F(KeptSettingsFile, ABrokenFileIsToldOfOnceAndKept) {
  const std::filesystem::path aside = file_.string() + ".broken";
  SettingsFile file;
  std::ofstream(file_) << "{";
  EXPECT_FALSE(file.load().fps);
  EXPECT_EQ(warnings(), 1);
  EXPECT_NE(said_.find("settings.json.broken"), std::string::npos) << said_;
  EXPECT_FALSE(std::filesystem::exists(aside)) << "not before something changes";
  file.change([](KeptSettings& kept) { kept.fps = 30; });
  file.change([](KeptSettings& kept) { kept.delta = 0.2; });
  EXPECT_EQ(warnings(), 1);
  EXPECT_EQ(textOf(aside), "{");
  EXPECT_EQ(file.load().fps, 30);
}

// What cannot be kept must not be replaced.
TEST_F(KeptSettingsFile, ABrokenFileThatCannotBeMovedStays) {
  std::filesystem::create_directories(file_.string() + ".broken/something");
  SettingsFile file;
  std::ofstream(file_) << "{";
  for (const double fps : {20.0, 30.0}) file.change([&](KeptSettings& kept) { kept.fps = fps; });
  EXPECT_EQ(warnings(), 1) << said_;
  EXPECT_EQ(textOf(file_), "{");
}

}  // namespace
}  // namespace saccade::app
