// Blender's Cycles as a peer: optional, run headless by cycles.py beside this file.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

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

/// Where a bake's light is asked for.
struct CyclesPoint {
  std::string object;      ///< its name in the scene
  core::Vec3 position{0};  ///< in the file's coordinates
};

struct CyclesBake {
  double bakeSeconds = 0;    ///< of the bake alone
  double unwrapSeconds = 0;  ///< of unwrapping, not in bakeSeconds; nor are import and Blender's own start
  std::vector<core::Vec3>
      irradiance;  ///< at each point, W/m^2, on the side that the surface's normal points to
};

/// The seconds in the line of JSON that cycles_bake.py prints, and its file of values. Throws core::Error
/// where one of them is missing or there is not one value a point.
CyclesBake parseCyclesBake(const std::string& output, const std::string& values, std::size_t points);

/// Diffuse light, direct and indirect, of the objects that the points name, in one atlas of 512 x 512 texels,
/// `spp` samples a texel, with the settings that cycles_bake.py says; its files go to `folder`. Throws
/// core::Error.
CyclesBake bakeWithCycles(const std::string& scene, const std::vector<CyclesPoint>& points, int spp,
                          int threads, const std::filesystem::path& folder, const std::stop_token& stop);

}  // namespace saccade::bench
