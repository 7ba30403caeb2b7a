// saccade info: what a scene holds and what the program makes of it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/cli/console.h"
#include "app/cli/options.h"
#include "app/commands.h"
#include "app/session/workspace.h"

namespace saccade::app {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(const core::Vec3& v) { return Json::array({v.x, v.y, v.z}); }

std::size_t lightCount(const core::Scene& scene) {
  std::size_t n = scene.lights.size();
  for (const core::Object& object : scene.objects)
    n += scene.materials[static_cast<std::size_t>(object.material)].emits() ? 1 : 0;
  return n;
}

Json describe(const core::Scene& scene, const core::Plan& plan) {
  Json json;
  json["scene"] = scene.path;
  json["objects"] = scene.objects.size();
  json["nondiffuse_objects"] = scene.idCount();
  json["triangles"] = scene.triangleCount();
  json["stored_triangles"] = scene.storedTriangleCount();
  json["materials"] = scene.materials.size();
  json["textures"] = scene.textures.size();
  json["lights"] = lightCount(scene);
  json["default_light"] = scene.defaultLight;
  json["environment"] = scene.environment ? Json(scene.environment->name) : Json(nullptr);
  json["cameras"] = Json::array();
  for (const core::Camera& camera : scene.cameras) {
    json["cameras"].push_back({{"name", camera.name},
                               {"eye", toJson(camera.eye)},
                               {"at", toJson(camera.at)},
                               {"up", toJson(camera.up)},
                               {"fov", camera.fovYDegrees}});
  }
  json["animations"] = Json::array();
  for (const core::Animation& animation : scene.animations)
    json["animations"].push_back({{"name", animation.name}, {"seconds", animation.lastSeconds}});
  json["time"] = scene.timeSeconds;
  json["default_camera"] = scene.defaultCamera;
  json["bounds"] = {{"min", toJson(scene.bounds.lo)}, {"max", toJson(scene.bounds.hi)}};
  json["warnings"] = scene.warnings;
  json["plan"] = Json::array();
  for (const core::PlanLine& line : plan.lines) {
    json["plan"].push_back({{"stage", line.stage}, {"on", line.on}, {"reason", line.reason}});
  }
  return json;
}

void print(const core::Scene& scene, const core::Plan& plan) {
  std::printf("%s\n", scene.path.c_str());
  std::printf("  %zu objects (%u non-diffuse), %zu triangles (%zu in memory), %zu materials, %zu textures\n",
              scene.objects.size(), scene.idCount(), scene.triangleCount(), scene.storedTriangleCount(),
              scene.materials.size(), scene.textures.size());
  std::printf(
      "  %zu %s%s\n", lightCount(scene), lightCount(scene) == 1 ? "light" : "lights",
      scene.defaultLight ? ", a default panel among them: the file has none that one would see by" : "");
  const core::Bounds& b = scene.bounds;
  std::printf("  bounds (%.2f, %.2f, %.2f) to (%.2f, %.2f, %.2f) m\n", b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y,
              b.hi.z);
  for (const core::Camera& c : scene.cameras) {
    std::printf("  camera '%s' at (%.2f, %.2f, %.2f), %.1f degrees\n", c.name.c_str(), c.eye.x, c.eye.y,
                c.eye.z, c.fovYDegrees);
  }
  double seconds = 0;
  for (const core::Animation& a : scene.animations) seconds = std::max(seconds, a.lastSeconds);
  if (!scene.animations.empty())
    std::printf("  %zu animations of up to %g s, shown at %g s (--time)\n", scene.animations.size(), seconds,
                scene.timeSeconds);
  std::printf("  plan:\n");
  for (const core::PlanLine& line : plan.lines) {
    std::printf("    %-22s %-3s  %s\n", line.stage.c_str(), line.on ? "on" : "off", line.reason.c_str());
  }
}

int info(const SceneOptions& options, bool json) {
  const core::Scene scene = core::loadScene(options.path, options.load);
  const core::Plan plan = core::makePlan(scene, options.mapsMegabytes);
  if (json) {
    std::printf("%s\n", describe(scene, plan).dump(2).c_str());
  } else {
    print(scene, plan);
  }
  printWarnings(scene.warnings);
  return 0;
}

}  // namespace

void addInfoCommand(CLI::App& program, Run& run) {
  CLI::App* command =
      program.add_subcommand("info", "Say what a scene holds and what will run for it, with reasons");
  auto scene = std::make_shared<SceneOptions>();
  auto json = std::make_shared<bool>(false);
  addSceneOptions(*command, *scene);
  command->add_flag("--json", *json, "Machine-readable output");
  command->callback([scene, json, &run] { run = [scene, json] { return info(*scene, *json); }; });
}

}  // namespace saccade::app
