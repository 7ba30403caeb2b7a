// A bake that may take hours: progress with time left, and a checkpoint beside the maps file to go on from.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>

#include "core/maps.h"
#include "raytrace/bake/baker.h"

namespace saccade::app {

/// Where a bake whose maps go to `maps` keeps what it has found: `maps`.part
std::filesystem::path checkpointPath(const std::filesystem::path& maps);

struct LongBake {
  std::filesystem::path maps;  ///< where the maps will go
  std::uint64_t sceneKey = 0;
  /// Go on from a checkpoint that is there. Otherwise it is replaced by the first new one.
  bool resume = false;
  /// The `bake` command, as opposed to a bake that another command needs: a checkpoint that does not fit is
  /// an error, no warning, and resuming is asked for by an option.
  bool explicitly = false;
  std::chrono::seconds every{60};  ///< at the latest so often a checkpoint is written; 0: every chance
};

/// Bakes on from a checkpoint or anew, saying so; writes checkpoints, also when `stop` is requested. A
/// checkpoint that cannot be written is a warning. Call forgetCheckpoint when the maps are stored. Throws
/// core::Error when stopped, with how to go on. `report`, besides the console: as BakeJob::advance has it.
core::IlluminationMaps bakeLong(raytrace::BakeJob& job, core::SceneCharts charts, const LongBake& bake,
                                const std::stop_token& stop, const raytrace::BakeReport& report = {});

/// "; the same command goes on from ..." where a checkpoint is there, else nothing. `explicitly`: LongBake.
std::string howToGoOn(const std::filesystem::path& maps, bool explicitly);

/// Removes the checkpoint of maps that are finished.
void forgetCheckpoint(const std::filesystem::path& maps);

}  // namespace saccade::app
