#include "app/viewer/panel.h"

#include <imgui/imgui.h>

#include <algorithm>

#include "app/viewer/error_plot.h"

namespace saccade::app {

void FrameTimes::add(float milliseconds) {
  if (values_.size() == kShown) values_.erase(values_.begin());
  values_.push_back(milliseconds);
}

const std::vector<KeyHelp>& keyHelp() {
  static const std::vector<KeyHelp> keys{{"W A S D, arrows", "walk"},
                                         {"Q / E", "down / up"},
                                         {"Shift", "four times as fast"},
                                         {"drag with left button", "look around"},
                                         {"right click", "mouse-look on, Esc: off"},
                                         {"wheel", "zoom"},
                                         {"1 to 5", "overlay: IDs, saliency, level, thread, age"},
                                         {"0", "no overlay"},
                                         {"C", "corrections on / off"},
                                         {"R", "reuse of samples on / off"},
                                         {"Home", "back to the first camera"},
                                         {"Tab", "panel on / off"},
                                         {"F11", "full screen"},
                                         {"F12", "save a screenshot"},
                                         {"F1", "these keys"},
                                         {"Esc", "leave mouse-look; else close"}};
  return keys;
}

namespace {

void drawControls(PanelState& s, UiItems& items) {
  ImGui::TextUnformatted("Attention");
  ImGui::SliderFloat("##attention", &s.attention, 0, 1, "");
  items.note("attention");
  ImGui::TextUnformatted("saliency");
  ImGui::SameLine(kPanelWidth - 110);
  ImGui::TextUnformatted("task");
  ImGui::SliderFloat("fps", &s.fps, 1, 60, "%.0f");
  items.note("fps");
  ImGui::SliderFloat("EV", &s.exposureEv, -8, 8, "%+.1f");
  items.note("exposure");
  ImGui::SliderFloat("delta", &s.delta, 0.01f, 0.4f, "%.2f");
  items.note("delta");
  ImGui::Checkbox("corrections", &s.corrections);
  items.note("corrections");
  ImGui::SameLine();
  ImGui::Checkbox("reuse samples", &s.reuse);
  items.note("reuse");
}

void drawOverlayChoice(PanelState& s, UiItems& items) {
  const char* current = s.overlay ? aovNames()[static_cast<std::size_t>(*s.overlay)].c_str() : "none";
  if (ImGui::BeginCombo("overlay", current)) {
    if (ImGui::Selectable("none", !s.overlay)) s.overlay.reset();
    for (std::size_t i = 0; i < aovNames().size(); ++i) {
      const auto aov = static_cast<Aov>(i);
      if (ImGui::Selectable(aovNames()[i].c_str(), s.overlay == aov)) s.overlay = aov;
    }
    ImGui::EndCombo();
  }
  items.note("overlay");
  if (s.overlay) ImGui::TextWrapped("%s", aovLegend(*s.overlay));
}

void drawFrameTimes(const PanelState& s, const FrameTimes& times) {
  const float budget = 1000 / s.fps;
  const std::vector<float>& values = times.values();
  const float last = values.empty() ? 0 : values.back();
  float mean = 0;
  for (const float ms : values) mean += ms / static_cast<float>(values.size());
  ImGui::Text("%.1f frames/s (%.1f ms, budget %.1f)", mean > 0 ? 1000 / mean : 0.0f, last, budget);
  ImGui::PlotLines("##times", values.data(), static_cast<int>(values.size()), 0, "frame time", 0, 2 * budget,
                   ImVec2(kPanelWidth - 30, 60));
}

void drawCounts(const FrameLoop& loop) {
  const RunStats& stats = loop.stats();
  const std::uint32_t pixels = loop.frame().nonDiffusePixels;
  const float done =
      pixels > 0 ? static_cast<float>(loop.layer().exactCount()) / static_cast<float>(pixels) : 1.0f;
  ImGui::ProgressBar(done, ImVec2(kPanelWidth - 30, 0), loop.converged() ? "converged" : nullptr);
  ImGui::Text(
      "new samples a frame: %llu",
      static_cast<unsigned long long>(stats.samplesPerFrame.empty() ? 0 : stats.samplesPerFrame.back()));
  ImGui::Text("cached samples: %zu", loop.cache().size());
  ImGui::Text("non-diffuse pixels: %u", pixels);
}

void drawKeys(PanelState& s, int height) {
  ImGui::SetNextWindowPos(ImVec2(20, 20), ImGuiCond_Always);
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(600, static_cast<float>(height) - 40));
  if (ImGui::Begin("Keys (F1)", &s.showKeys,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    for (const KeyHelp& line : keyHelp()) {
      ImGui::TextUnformatted(line.keys);
      ImGui::SameLine(190);
      ImGui::TextUnformatted(line.action);
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
  ImGui::PushItemWidth(kPanelWidth - 90);
  drawControls(state, view.items);
  ImGui::Separator();
  drawOverlayChoice(state, view.items);
  ImGui::Separator();
  drawFrameTimes(state, view.times);
  drawCounts(view.loop);
  ImGui::Separator();
  if (ImGui::Button("Screenshot (F12)")) state.screenshotWanted = true;
  view.items.note("screenshot");
  ImGui::SameLine();
  if (ImGui::Button("Keys (F1)")) state.showKeys = !state.showKeys;
  view.items.note("keys");
  if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
  ImGui::SetNextItemOpen(state.errorPlotOpen);
  state.errorPlotOpen = ImGui::CollapsingHeader("Error against seconds at rest");
  view.items.note("errorPlot");
  if (state.errorPlotOpen) drawErrorPlot(view.error, state.corrections);
  ImGui::PopItemWidth();
  ImGui::End();
}

}  // namespace saccade::app
