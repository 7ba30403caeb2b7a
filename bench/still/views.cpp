#include "bench/still/views.h"

namespace saccade::bench {
namespace {

StillView quickView(const std::string& file) {
  return {file, "preview", {128, 128}, {.relmse = 5e-3, .capSeconds = 15}, 0.25};
}
StillView paperView(const std::string& file) {
  return {file, "medium", {256, 256}, {.relmse = 3e-3, .capSeconds = 140}, 0.8};
}
StillView fullView(const std::string& file) {
  return {file, "medium", {512, 512}, {.relmse = 1e-3, .capSeconds = 900}, 20};
}

}  // namespace

std::vector<StillView> stillViews(const Session& session) {
  std::vector<StillView> views;
  const auto usual = session.quick() ? quickView : paperView;
  for (const std::string& file : session.options().scenes) views.push_back(usual(file));
  if (!views.empty()) return views;
  views.push_back(usual(bundledScene("cornell")));
  if (session.quick()) return views;
  for (const char* name : {"table", "gallery"}) views.push_back(usual(bundledScene(name)));
  if (!session.full()) return views;
  if (const auto glossy = sharedFile("references/cycles/cornell_glossy.glb")) {
    views.push_back(fullView(*glossy));
  } else {
    session.say("no cornell_glossy: the shared folder is absent (set SACCADE_SHARED)");
  }
  return views;
}

Reference referenceOf(const app::Workspace& workspace, const StillView& view, const std::stop_token& stop) {
  ReferenceView wanted;
  wanted.camera = app::chooseCamera(workspace.scene, {});
  wanted.size = view.size;
  return referenceOf(workspace, wanted, view.confidence, stop);
}

}  // namespace saccade::bench
