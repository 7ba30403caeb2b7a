// An off-screen context with the base renderer in it, as every command without a window needs.
#pragma once

#include <chrono>
#include <memory>

#include "app/cli/options.h"
#include "app/session/workspace.h"
#include "render/base/base_renderer.h"
#include "render/context/gl_context.h"

namespace saccade::app {

/// Main thread only. Throws core::Error when the context cannot be made.
struct Headless {
  Headless(const RunOptions& run, const Workspace& workspace);

  std::unique_ptr<render::GlContext> context;
  std::unique_ptr<render::BaseRenderer> renderer;
};

/// Threads left to Mesa's software rasteriser beside the tracers, which compete with it for the cores.
int rasterThreads(int tracers);

inline double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace saccade::app
