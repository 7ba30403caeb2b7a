#include "app/session/headless.h"

#include <algorithm>
#include <thread>

namespace saccade::app {

int rasterThreads(int tracers) {
  // The rasteriser's threads work while the main thread waits for them: they are counted as one core's worth.
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores - tracers);
}

Headless::Headless(const RunOptions& run, const Workspace& workspace) {
  render::setSoftwareRasterThreads(rasterThreads(tracerThreads(run)));
  context = render::makeHeadlessContext(run.context == "egl" ? render::ContextKind::egl
                                                             : render::ContextKind::osmesa);
  renderer = std::make_unique<render::BaseRenderer>(*context, workspace.scene);
  renderer->setMaps(&workspace.maps);
}

}  // namespace saccade::app
