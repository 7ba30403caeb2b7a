// A scene made ready to walk: loaded, charted, its maps read or baked, its ray-tracing world built.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/cli/options.h"
#include "core/maps.h"
#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "raytrace/world.h"

namespace saccade::app {

/// Not copyable: the world refers to scene and maps. Read-only after opening, but for the world already once
/// readWorkspace has returned; any thread may read what is read-only.
struct Workspace {
  core::Scene scene;  ///< charted
  core::Plan plan;
  core::IlluminationMaps maps;
  bool mapsWereThere = false;  ///< read from a file, not baked
  bool mapsAreKept = true;     ///< in their file; false: that cannot be written, which was said
  std::unique_ptr<raytrace::World> world;

  Workspace() = default;
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
};

struct BakeRequest {
  std::filesystem::path file;  ///< where the maps go; empty = the cache folder
  bool always = false;         ///< bake even when a valid file exists (the `bake` command)
  int threads = 1;             ///< 0 = inline
  std::uint32_t seed = 1;
  std::filesystem::path importFolder;  ///< lightmaps of another program; empty = none
  float importScale = 1;               ///< irradiance = pi * value * scale
  bool resume = false;                 ///< go on from a checkpoint (a bake that is not `always` does anyway)
  std::chrono::seconds checkpointEvery{60};
  bool chartsOnly = false;  ///< no light by vertex, for exports; maps with any are baked again
};

/// What opening a scene is at.
struct OpeningStep {
  std::string what;         ///< "reading the scene", "baking: final gathering"
  double fraction = -1;     ///< done, in [0, 1]; < 0 = not known
  double secondsLeft = -1;  ///< < 0 = not known
};
/// Called on whichever thread does the work.
using OpeningReport = std::function<void(const OpeningStep&)>;

/// Loads the scene and prints its warnings. Throws core::Error.
core::Scene loadSceneReported(const SceneOptions& options);

/// Loads, charts, reads or bakes the maps (with a progress bar on the console, saying so) and builds the
/// world. Throws core::Error, also where `stop` was requested meanwhile: then with how to go on, if a bake
/// kept something. Any thread; `report` may be empty.
std::unique_ptr<Workspace> openWorkspace(const SceneOptions& options, const BakeRequest& bake,
                                         const std::stop_token& stop, const OpeningReport& report = {});

/// The first half of that: all that the base layer needs. There is no world yet, unless maps were baked.
std::unique_ptr<Workspace> readWorkspace(const SceneOptions& options, const BakeRequest& bake,
                                         const std::stop_token& stop, const OpeningReport& report = {});
/// The second half: the world, with the maps.
void finishWorkspace(Workspace& workspace, const std::stop_token& stop, const OpeningReport& report = {});

/// Scene and world without maps: what `path` and `info` need. The world has no maps set.
std::unique_ptr<Workspace> openWithoutMaps(const SceneOptions& options);

/// The file that openWorkspace uses for maps of this key.
std::filesystem::path mapsPath(std::uint64_t key, const SceneOptions& options, const BakeRequest& bake);

}  // namespace saccade::app
