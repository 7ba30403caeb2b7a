#include "app/viewer/panel.h"

#include <imgui/imgui.h>

#include <algorithm>

#include "app/viewer/error_plot.h"
#include "app/viewer/legend_view.h"

namespace saccade::app {

const std::vector<KeyHelp>& keyHelp() {
  static const std::vector<KeyHelp> keys{{"W A S D, arrows", "walk"},
                                         {"Q / E", "down / up"},
                                         {"Shift", "four times as fast"},
                                         {"drag with left button", "look around"},
                                         {"click", "pick an object, and attend to it"},
                                         {"right click", "mouse-look on, Esc: off"},
                                         {"wheel", "zoom"},
                                         {"1 to 9", "overlays, in the order of the list"},
                                         {"0", "no overlay"},
                                         {"C", "corrections on / off"},
                                         {"R", "reuse of samples on / off"},
                                         {"Home", "fly back to the first camera"},
                                         {"B", "keep this place"},
                                         {"F2 to F9", "fly to place 1 to 8"},
                                         {"Control + F2 to F9", "keep this place there instead"},
                                         {"T", "record a path; again: save it"},
                                         {"P", "play the path; again: stop"},
                                         {"L", "path in a loop on / off"},
                                         {"Tab", "panel on / off"},
                                         {"F11", "full screen"},
                                         {"F12", "save a screenshot (Shift: as EXR)"},
                                         {"F1", "these keys"},
                                         {"Esc", "leave mouse-look; else close"}};
  return keys;
}

namespace {

constexpr float kMessageLines = 4;

float em() { return ImGui::GetFontSize(); }
float fullWidth() { return ImGui::GetContentRegionAvail().x; }

bool section(const char* title, UiItems& items, const char* item, bool open = true) {
  const bool isOpen = ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  items.note(item);
  return isOpen;
}

bool button(const char* label, UiItems& items, const std::string& item) {
  const bool pressed = ImGui::Button(label);
  items.note(item);
  return pressed;
}

void drawAttention(PanelState& s, UiItems& items) {
  ImGui::SetNextItemWidth(fullWidth());
  ImGui::SliderFloat("##attention", &s.attention, 0, 1, "%.2f");
  items.note("attention");
  ImGui::TextUnformatted("saliency");
  ImGui::SameLine(ImGui::GetCursorPosX() + fullWidth() - ImGui::CalcTextSize("task").x);
  ImGui::TextUnformatted("task");
}

void drawPicture(PanelState& s, UiItems& items) {
  ImGui::SliderFloat("exposure", &s.exposureEv, -8, 8, "%+.1f EV");
  items.note("exposure");
  ImGui::SliderFloat("frames/s", &s.fps, 1, 60, "%.0f");
  items.note("fps");
  ImGui::SliderFloat("delta", &s.delta, 0.01f, 0.4f, "%.2f");
  items.note("delta");
  ImGui::Checkbox("corrections", &s.corrections);
  items.note("corrections");
  ImGui::SameLine();
  ImGui::Checkbox("reuse samples", &s.reuse);
  items.note("reuse");
  ImGui::Checkbox("approximate until corrected", &s.approximation);
  items.note("approximation");
  if (button("Screenshot", items, "screenshot")) s.screenshotWanted = true;
  ImGui::SameLine();
  if (button("EXR", items, "exr")) s.exrWanted = true;
  ImGui::SameLine();
  if (button("Keys (F1)", items, "keys")) s.showKeys = !s.showKeys;
}

void drawOverlayChoice(PanelState& s, const PanelView& view) {
  const char* current = s.overlay ? aovNames()[static_cast<std::size_t>(*s.overlay)].c_str() : "none";
  if (ImGui::BeginCombo("shown", current)) {
    if (ImGui::Selectable("none", !s.overlay)) s.overlay.reset();
    view.items.note("overlay none");
    for (std::size_t i = 0; i < aovNames().size(); ++i) {
      const auto aov = static_cast<Aov>(i);
      if (ImGui::Selectable(aovNames()[i].c_str(), s.overlay == aov)) s.overlay = aov;
      view.items.note("overlay " + aovNames()[i]);
    }
    ImGui::EndCombo();
  }
  view.items.note("overlay");
  if (!s.overlay || !view.overlay) return;
  ImGui::SliderFloat("strength", &s.overlayStrength, 0.1f, 1, "%.1f");
  view.items.note("overlayStrength");
  drawLegend(view.overlay->legend, view.overlay->scale);
}

void drawPicked(const PanelView& view) {
  const std::optional<PickedObject>& picked = view.tools.picked();
  if (!picked) return ImGui::TextWrapped("Click on an object in the picture.");
  ImGui::TextWrapped("%s", picked->name.c_str());
  ImGui::TextWrapped("material: %s", picked->material.empty() ? "without name" : picked->material.c_str());
  for (const std::string& lobe : picked->lobes) ImGui::BulletText("%s", lobe.c_str());
  if (picked->id > 0) {
    ImGui::Text("non-diffuse, id %u: corrected", picked->id);
  } else {
    ImGui::TextUnformatted("diffuse: from the maps alone");
  }
  ImGui::Text("%.2f m away", static_cast<double>(picked->distance));
}

void drawPlaces(PanelState& s, const PanelView& view) {
  if (button("Keep this place (B)", view.items, "bookmark")) s.wanted.addBookmark = true;
  const std::vector<core::Camera>& places = view.tools.bookmarks();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    ImGui::PushID(static_cast<int>(i));
    if (button(places[i].name.c_str(), view.items, "place " + number)) s.wanted.goTo = i;
    ImGui::SameLine();
    if (button("set", view.items, "set " + number)) s.wanted.setBookmark = i;
    ImGui::SameLine();
    if (button("remove", view.items, "remove " + number)) s.wanted.removeBookmark = i;
    ImGui::PopID();
  }
}

void drawPath(PanelState& s, const PanelView& view) {
  const SceneTools& tools = view.tools;
  if (button(tools.recording() ? "Stop and save (T)" : "Record path (T)", view.items, "recordPath"))
    s.wanted.recordPath = true;
  ImGui::SameLine();
  if (button(tools.playing() ? "Stop (P)" : "Play (P)", view.items, "playPath")) s.wanted.playPath = true;
  ImGui::Checkbox("in a loop (L)", &s.loopPath);
  view.items.note("loopPath");
  if (tools.recording()) ImGui::Text("recording: %.1f s", tools.recordedSeconds());
}

void drawProgress(const FrameLoop& loop) {
  const RunStats& stats = loop.stats();
  const std::uint32_t pixels = loop.frame().nonDiffusePixels;
  const float done =
      pixels > 0 ? static_cast<float>(loop.layer().exactCount()) / static_cast<float>(pixels) : 1.0f;
  ImGui::ProgressBar(done, ImVec2(fullWidth(), 0), loop.converged() ? "converged" : nullptr);
  ImGui::Text(
      "%llu new samples a frame, %zu cached",
      static_cast<unsigned long long>(stats.samplesPerFrame.empty() ? 0 : stats.samplesPerFrame.back()),
      loop.cache().size());
  ImGui::Text("%u non-diffuse pixels", pixels);
}

/// Closed at first: a line says that there is something to know.
void drawNotes(const std::vector<std::string>& notes, UiItems& items) {
  if (notes.empty()) return;
  // What follows ### identifies the section, so that it stays open for the next scene.
  const std::string title = "Notes on the scene: " + std::to_string(notes.size()) + "###notes";
  if (!section(title.c_str(), items, "section notes", false)) return;
  ImGui::BeginGroup();
  for (const std::string& note : notes) {
    ImGui::Bullet();
    ImGui::TextWrapped("%s", note.c_str());
  }
  ImGui::EndGroup();
  items.note("notes");
}

void drawSections(PanelState& s, const PanelView& view) {
  drawNotes(view.notes, view.items);
  if (section("Attention", view.items, "section attention")) drawAttention(s, view.items);
  if (section("Picture", view.items, "section picture")) drawPicture(s, view.items);
  if (section("Overlay", view.items, "section overlay")) drawOverlayChoice(s, view);
  if (section("Object", view.items, "section object")) drawPicked(view);
  if (section("Places and paths", view.items, "section places")) {
    drawPlaces(s, view);
    drawPath(s, view);
  }
  if (section("Frame time", view.items, "section times")) {
    drawStageBars(view.times, 1000 / s.fps);
    drawProgress(view.loop);
  }
  ImGui::SetNextItemOpen(s.errorPlotOpen);
  s.errorPlotOpen = section("Error against seconds at rest", view.items, "errorPlot");
  if (s.errorPlotOpen) drawErrorPlot(view.error, s.corrections);
}

void drawKeys(PanelState& s, int height) {
  const float line = em();
  ImGui::SetNextWindowPos(ImVec2(line, line), ImGuiCond_Always);
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(46 * line, static_cast<float>(height) - 2 * line));
  if (ImGui::Begin("Keys (F1)", &s.showKeys,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    for (const KeyHelp& help : keyHelp()) {
      ImGui::TextUnformatted(help.keys);
      ImGui::SameLine(14 * line);
      ImGui::TextUnformatted(help.action);
    }
  }
  ImGui::End();
}

}  // namespace

void drawPanel(PanelState& state, const PanelView& view) {
  if (state.showKeys) drawKeys(state, view.area.height);
  if (view.area.width < 1) return;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(view.area.x), static_cast<float>(view.area.y)));
  ImGui::SetNextWindowSize(ImVec2(static_cast<float>(view.area.width), static_cast<float>(view.area.height)));
  ImGui::Begin("Saccade", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
  // Messages have a place of their own and the scroll bar is always there, so that no control moves away from
  // under the pointer.
  ImGui::BeginChild("sections", ImVec2(0, -kMessageLines * ImGui::GetTextLineHeightWithSpacing()), false,
                    ImGuiWindowFlags_AlwaysVerticalScrollbar);
  ImGui::PushItemWidth(-6 * em());  // room for the labels
  drawSections(state, view);
  ImGui::PopItemWidth();
  ImGui::EndChild();
  ImGui::Separator();
  ImGui::BeginChild("message");
  ImGui::TextWrapped("%s", state.message.c_str());
  ImGui::EndChild();
  ImGui::End();
}

}  // namespace saccade::app
