// Scenes opened once per test program, with small maps: the promise of convergence does not depend on their
// quality.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "app/session/frame_loop.h"
#include "app/session/headless.h"
#include "app/session/workspace.h"
#include "core/composite.h"
#include "raytrace/reference.h"
#include "tests/shared_folder.h"
#include "tests/temporary_folder.h"

namespace saccade::tests {

inline std::filesystem::path bundled(const std::string& name) {
  return std::filesystem::path(SACCADE_SOURCE_DIR) / "data" / "scenes" / name;
}

/// Opened scenes are kept: baking is the slow part.
inline const app::Workspace& workspaceOf(const std::filesystem::path& scene, float unitScale = 1) {
  static std::map<std::string, std::unique_ptr<app::Workspace>> opened;
  auto& workspace = opened[scene.string()];
  if (!workspace) {
    app::SceneOptions options;
    options.path = scene.string();
    options.load.unitScale = unitScale;
    options.quality = "preview";
    options.photons = 50000;
    app::BakeRequest bake;
    bake.file = temporaryFolder() / (scene.filename().string() + ".maps");
    bake.threads = 2;
    workspace = app::openWorkspace(options, bake, {});
  }
  return *workspace;
}

inline app::RunOptions runOn(const std::string& context) {
  app::RunOptions run;
  run.context = context;
  return run;
}

/// base + every correction in scanline order: neither queues nor splats.
inline core::ImageRgb rayTraced(const app::Workspace& workspace, const core::FrameSnapshot& frame,
                                std::uint32_t seed = 1) {
  const raytrace::CorrectiveTracer tracer(*workspace.world, {.seed = seed});
  const raytrace::TraceAllResult all = raytrace::traceAll(tracer, frame, 2, {});
  return core::compositeLinear(frame.view.width(), frame.view.height(), frame.baseAndId, all.corrections);
}

inline float largestDifference(const core::ImageRgb& a, const core::ImageRgb& b) {
  EXPECT_EQ(a.pixels().size(), b.pixels().size());
  float largest = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float difference = std::abs(a.pixels()[i][c] - b.pixels()[i][c]);
      if (!(difference <= largest)) largest = difference;  // keeps a NaN
    }
  }
  return largest;
}

inline int levelsThatOccur(const app::RunStats& stats) {
  int n = 0;
  for (const std::uint64_t count : stats.levels) n += count > 0 ? 1 : 0;
  return n;
}

}  // namespace saccade::tests
