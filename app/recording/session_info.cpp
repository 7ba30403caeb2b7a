#include "app/recording/session_info.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/maps.h"

namespace saccade::app {

std::string cpuName() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    return colon == std::string::npos ? "" : line.substr(colon + 2);
  }
  return "";
}

SessionInfo describeSession(const SceneOptions& scene, const std::filesystem::path& maps,
                            const Workspace& workspace, const RunOptions& run,
                            const CorrectiveOptions& corrective, RecordedOn on) {
  SessionInfo info;
  info.scene = scene;
  info.scene.path = std::filesystem::absolute(scene.path).string();
  if (!scene.load.environment.empty())
    info.scene.load.environment = std::filesystem::absolute(scene.load.environment).string();
  info.sceneHash = workspace.maps.key;
  info.maps = std::filesystem::absolute(maps);
  info.mapsHash = core::contentHash(workspace.maps);
  info.on = std::move(on);
  info.seed = run.seed;
  info.threads = tracerThreads(run);
  info.corrective = corrective;
  return info;
}

std::string loadOptionsText(const core::LoadOptions& o) {
  const nlohmann::ordered_json json = {{"unit_scale", o.unitScale},
                                       {"scene", o.scene},
                                       {"time", o.timeSeconds},
                                       {"nondiffuse", o.nonDiffuseThreshold},
                                       {"light", o.lights},
                                       {"environment", o.environment},
                                       {"environment_rotation", o.environmentOptions.rotationDegrees},
                                       {"environment_scale", o.environmentOptions.scale}};
  return json.dump();
}

core::LoadOptions parseLoadOptions(const std::string& text) {
  core::LoadOptions o;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    json.at("unit_scale").get_to(o.unitScale);
    json.at("scene").get_to(o.scene);
    json.at("time").get_to(o.timeSeconds);
    json.at("nondiffuse").get_to(o.nonDiffuseThreshold);
    json.at("light").get_to(o.lights);
    json.at("environment").get_to(o.environment);
    json.at("environment_rotation").get_to(o.environmentOptions.rotationDegrees);
    json.at("environment_scale").get_to(o.environmentOptions.scale);
  } catch (const nlohmann::json::exception&) {
    throw core::Error("how the scene was read cannot be made out; record the session again");
  }
  return o;
}

}  // namespace saccade::app
