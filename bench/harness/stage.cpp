#include "bench/harness/experiment.h"
#include "bench/harness/machine.h"
#include "bench/harness/method.h"

namespace saccade::bench {

core::View Stage::view(const core::Camera& camera, app::ImageSize size) const {
  return {camera, size.width, size.height, workspace->scene.bounds};
}

std::unique_ptr<Stage> openStage(const std::string& file, const std::string& quality, std::uint32_t seed,
                                 const std::stop_token& stop) {
  auto stage = std::make_unique<Stage>();
  stage->name = sceneName(file);
  stage->cores = static_cast<int>(std::thread::hardware_concurrency());
  stage->tracers = app::tracerThreads({});
  stage->seed = seed;
  app::SceneOptions scene;
  scene.path = file;
  scene.quality = quality;
  stage->workspace = app::openWorkspace(scene, {.threads = stage->cores, .seed = seed}, stop);
  // The rasteriser's threads inherit the main thread's cores.
  const Pinned main(mainCores());
  stage->gl = std::make_unique<app::Headless>(app::RunOptions{}, *stage->workspace);
  return stage;
}

std::unique_ptr<app::FrameLoop> pinnedLoop(const Stage& stage, app::FrameLoopOptions options) {
  // Threads inherit the cores of the one that starts them.
  const Pinned workers(workerCores(options.threads));
  return std::make_unique<app::FrameLoop>(*stage.workspace, *stage.gl->renderer, options);
}

}  // namespace saccade::bench
