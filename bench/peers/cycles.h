// Blender's Cycles as a peer: optional, run headless by cycles.py beside this file.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "core/image.h"

namespace saccade::bench {

/// What someone does who wants it in the comparison.
inline constexpr const char* kCyclesMissing =
    "not installed; apt-get install blender, and give the command again";

/// "Blender 3.4.1"; nothing where Blender is not installed.
std::optional<std::string> cyclesVersion();

struct CyclesPicture {
  double renderSeconds = 0;  ///< of the rendering alone
  double importSeconds = 0;  ///< of reading the scene, not in renderSeconds; nor is Blender's own start
  std::filesystem::path file;
};

/// The line of JSON that cycles.py prints, found among what Blender prints. Throws core::Error where there is
/// none.
CyclesPicture parseCyclesOutput(const std::string& output);

/// `spp` samples a pixel of `scene` from its own camera, 512 x 512, with the settings that cycles.py says;
/// the picture goes to `folder`. Throws core::Error.
CyclesPicture renderWithCycles(const std::string& scene, int spp, int threads, int seed,
                               const std::filesystem::path& folder, const std::stop_token& stop);

}  // namespace saccade::bench
