#include "bench/peers/cycles.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/harness/machine.h"
#include "bench/harness/process.h"
#include "core/error.h"

namespace saccade::bench {

std::optional<std::string> cyclesVersion() {
  const std::string line = firstLineOf("blender --version 2>/dev/null");
  if (line.rfind("Blender", 0) != 0) return std::nullopt;
  return line;
}

CyclesPicture parseCyclesOutput(const std::string& output) {
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("render_s")) continue;
    try {
      return {json.at("render_s").get<double>(), json.at("import_s").get<double>(),
              json.at("file").get<std::string>()};
    } catch (const nlohmann::json::exception& e) {
      throw core::Error(std::string("Cycles: its result is incomplete (") + e.what() + ")");
    }
  }
  throw core::Error("Cycles printed no result; run blender with bench/peers/cycles.py to see why");
}

CyclesPicture renderWithCycles(const std::string& scene, int spp, int threads, int seed,
                               const std::filesystem::path& folder, const std::stop_token& stop) {
  return parseCyclesOutput(
      outputOf("Cycles",
               {"blender", "-b", "--factory-startup", "-P", SACCADE_SOURCE_DIR "/bench/peers/cycles.py", "--",
                scene, "--spp", std::to_string(spp), "--threads", std::to_string(threads), "--seed",
                std::to_string(seed), "-o", std::filesystem::absolute(folder).string()},
               stop));
}

}  // namespace saccade::bench
