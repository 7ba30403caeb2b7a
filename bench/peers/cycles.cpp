#include "bench/peers/cycles.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/harness/machine.h"
#include "bench/harness/process.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

std::string scriptPath(const char* name) { return std::string(SACCADE_SOURCE_DIR "/bench/peers/") + name; }

/// The first line of JSON that has `key`, among what Blender prints. Throws core::Error where there is none.
nlohmann::json lineWith(const std::string& key, const std::string& output, const std::string& script) {
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_object() && json.contains(key)) return json;
  }
  throw core::Error("Cycles printed no result; run blender with bench/peers/" + script + " to see why");
}

}  // namespace

std::optional<std::string> cyclesVersion() {
  const std::string line = firstLineOf("blender --version 2>/dev/null");
  if (line.rfind("Blender", 0) != 0) return std::nullopt;
  return line;
}

CyclesPicture parseCyclesOutput(const std::string& output) {
  const nlohmann::json json = lineWith("render_s", output, "cycles.py");
  try {
    return {json.at("render_s").get<double>(), json.at("import_s").get<double>(),
            json.at("file").get<std::string>()};
  } catch (const nlohmann::json::exception& e) {
    throw core::Error(std::string("Cycles: its result is incomplete (") + e.what() + ")");
  }
}

CyclesPicture renderWithCycles(const std::string& scene, int spp, int threads, int seed,
                               const std::filesystem::path& folder, const std::stop_token& stop) {
  return parseCyclesOutput(
      outputOf("Cycles",
               {"blender", "-b", "--factory-startup", "-P", scriptPath("cycles.py"), "--", scene, "--spp",
                std::to_string(spp), "--threads", std::to_string(threads), "--seed", std::to_string(seed),
                "-o", std::filesystem::absolute(folder).string()},
               stop));
}

CyclesBake parseCyclesBake(const std::string& output, const std::string& values, std::size_t points) {
  const nlohmann::json json = lineWith("bake_s", output, "cycles_bake.py");
  try {
    CyclesBake bake{json.at("bake_s").get<double>(), json.at("unwrap_s").get<double>(), {}};
    for (const nlohmann::json& e : nlohmann::json::parse(values))
      bake.irradiance.emplace_back(e.at(0).get<float>(), e.at(1).get<float>(), e.at(2).get<float>());
    if (bake.irradiance.size() == points) return bake;
    throw core::Error("Cycles: its bake has " + std::to_string(bake.irradiance.size()) + " values for " +
                      std::to_string(points) + " points");
  } catch (const nlohmann::json::exception& e) {
    throw core::Error(std::string("Cycles: its bake is incomplete (") + e.what() + ")");
  }
}

CyclesBake bakeWithCycles(const std::string& scene, const std::vector<CyclesPoint>& points, int spp,
                          int threads, const std::filesystem::path& folder, const std::stop_token& stop) {
  const std::filesystem::path output = std::filesystem::absolute(folder);
  std::filesystem::create_directories(output);
  nlohmann::json list = nlohmann::json::array();
  for (const CyclesPoint& p : points)
    list.push_back({{"object", p.object}, {"at", {p.position.x, p.position.y, p.position.z}}});
  const std::string text = list.dump();
  core::writeFileAtomically(output / "points.json",
                            std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  const std::string printed =
      outputOf("Cycles",
               {"blender", "-b", "--factory-startup", "-P", scriptPath("cycles_bake.py"), "--", scene,
                "--points", (output / "points.json").string(), "--spp", std::to_string(spp), "--threads",
                std::to_string(threads), "-o", output.string()},
               stop);
  const std::vector<std::uint8_t> values = core::readWholeFile(output / "cycles_bake.json");
  return parseCyclesBake(printed, std::string(values.begin(), values.end()), points.size());
}

}  // namespace saccade::bench
