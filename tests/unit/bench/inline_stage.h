// Stages for tests: no tracer threads, so that every walk repeats exactly, and poor maps, on whose quality
// nothing depends.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include "bench/harness/experiment.h"
#include "bench/harness/method.h"

namespace saccade::bench {

/// Of this process, removed at its end.
inline const std::filesystem::path& stageFolder() {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("saccade-walkers-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

inline std::string mapsOf(const std::string& scene) { return (stageFolder() / (scene + ".maps")).string(); }

inline std::unique_ptr<Stage> inlineStage(const std::string& name) {
  auto stage = std::make_unique<Stage>();
  app::SceneOptions scene;
  scene.path = bundledScene(name);
  scene.quality = "preview";
  scene.photons = 10000;
  stage->tracers = 0;
  stage->cores = 2;
  stage->workspace = app::openWorkspace(scene, {.file = mapsOf(name), .threads = 2}, {});
  stage->gl = std::make_unique<app::Headless>(app::RunOptions{}, *stage->workspace);
  return stage;
}

inline Stage& inlineCornell() {
  static const std::unique_ptr<Stage> cornell = inlineStage("cornell");
  return *cornell;
}

}  // namespace saccade::bench
