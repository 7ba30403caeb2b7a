#include "bench/load/subjects.h"

#include <array>

namespace saccade::bench {

std::vector<Subject> subjectsOf(Session& session, const std::string& experiment,
                                const std::vector<std::string>& bundled) {
  std::vector<Subject> subjects;
  for (const std::string& file : session.options().scenes) subjects.push_back({file});
  if (!subjects.empty()) return subjects;
  for (const std::string& name : bundled) subjects.push_back({bundledScene(name)});
  if (session.quick()) return subjects;
  const std::array<Subject, 4> shared = {{{"scenes/rooms/chess-board_undraco.glb"},
                                          {"scenes/conference/conference.obj", "0.003"},
                                          {"scenes/samples/MetalRoughSpheresNoTextures.glb"},
                                          {"scenes/samples/WaterBottle.glb"}}};
  for (const Subject& s : shared) {
    if (const auto file = sharedFile(s.file)) {
      subjects.push_back({*file, s.unitScale});
    } else {
      session.say(experiment + ": " + s.file + " of the shared folder is not here; left out");
    }
  }
  return subjects;
}

app::SceneOptions optionsOf(const Subject& s) {
  app::SceneOptions options;
  options.path = s.file;
  options.quality = kSubjectQuality;
  options.load.unitScale = std::stof(s.unitScale);
  return options;
}

}  // namespace saccade::bench
