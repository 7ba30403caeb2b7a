// What a recorded session was made of and on: all that a replay must find again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/cli/options.h"
#include "app/recording/session_format.h"
#include "app/session/workspace.h"

namespace saccade::app {

/// Pictures are equal bit for bit only where all of this is.
struct RecordedOn {
  std::string context;   ///< render::GlContext::name
  std::string renderer;  ///< render::GlContext::renderer
  std::string cpu;       ///< cpuName()
  int format = kSessionVersion;

  bool operator==(const RecordedOn&) const = default;
};

struct SessionInfo {
  SceneOptions scene;  ///< path absolute; limits, quality and photons are not recorded
  std::uint64_t sceneHash = 0;
  std::filesystem::path maps;  ///< absolute
  std::uint64_t mapsHash = 0;
  RecordedOn on;
  std::uint32_t seed = 1;
  int threads = 0;
  CorrectiveOptions corrective;
};

/// The processor's model, as /proc/cpuinfo has it; empty where it does not tell.
std::string cpuName();

/// `maps`: the file the workspace's maps are in.
SessionInfo describeSession(const SceneOptions& scene, const std::filesystem::path& maps,
                            const Workspace& workspace, const RunOptions& run,
                            const CorrectiveOptions& corrective, RecordedOn on);

/// How the scene file was read, as JSON, and back. Throws core::Error on what this version does not know.
std::string loadOptionsText(const core::LoadOptions& options);
core::LoadOptions parseLoadOptions(const std::string& text);

}  // namespace saccade::app
