#include "bench/walkorder/scenes.h"

#include <cmath>
#include <glm/trigonometric.hpp>

namespace saccade::bench {
namespace {

/// A walk about what a person looks at, to both sides of `eye`.
struct Arc {
  const char* file;  ///< of the shared folder
  core::Vec3 eye, at;
  float degrees;
};

const Arc kArcs[] = {
    {"scenes/rooms/chess-board_undraco.glb", {70, 90, 130}, {-5, 5, 0}, 90},
    {"scenes/samples/MetalRoughSpheresNoTextures.glb", {0.0045f, 0.009f, 0.0125f}, {0.0045f, 0.006f, 0}, 60},
    {"scenes/conference/conference.obj", {1415, 389, -625}, {300, 150, -190}, 60}};

app::CameraPath pathOf(const Arc& arc) {
  constexpr int kKeys = 17;
  constexpr double kSeconds = 8;
  const core::Vec3 reach = arc.eye - arc.at;
  std::vector<app::CameraKey> keys;
  for (int i = 0; i < kKeys; ++i) {
    const float share = static_cast<float>(i) / (kKeys - 1);
    const float angle = glm::radians(arc.degrees) * (share - 0.5f);
    const float c = std::cos(angle), s = std::sin(angle);
    core::Camera camera;
    camera.eye = arc.at + core::Vec3(reach.x * c + reach.z * s, reach.y, reach.z * c - reach.x * s);
    camera.at = arc.at;
    keys.push_back({kSeconds * share, camera});
  }
  return app::CameraPath::through(std::move(keys));
}

}  // namespace

std::vector<WalkedScene> walkedScenes(Session& session) {
  std::vector<WalkedScene> scenes;
  for (const char* name : {"gallery", "table", "ward", "cornell"})
    scenes.push_back({bundledScene(name), app::CameraPath::read(bundledPath(name))});
  for (const Arc& arc : kArcs) {
    if (const auto file = sharedFile(arc.file)) {
      scenes.push_back({*file, pathOf(arc), true});
    } else {
      session.say(std::string("walk-order: ") + arc.file + " of the shared folder is not here; left out");
    }
  }
  return scenes;
}

}  // namespace saccade::bench
