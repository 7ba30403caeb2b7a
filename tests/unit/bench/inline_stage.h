// Stages for tests: no tracer threads, so that every walk repeats exactly, and poor maps, on whose quality
// nothing depends.
#pragma once

#include <memory>
#include <string>

#include "bench/harness/experiment.h"
#include "bench/harness/method.h"
#include "tests/temporary_folder.h"

namespace saccade::bench {

inline std::string mapsOf(const std::string& scene) {
  return (tests::temporaryFolder() / (scene + ".maps")).string();
}

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
