#include "app/viewer/start_screen.h"

#include <imgui/imgui.h>

#include <algorithm>
#include <cstdio>

#include "core/scene/load.h"

namespace saccade::app {

namespace {

constexpr float kWidthInLetters = 34;  ///< of the windows below, in heights of a letter

/// A window of fixed width in the middle of the area, `place` of its height down.
void beginCentred(const char* title, const render::PixelRect& area, float place) {
  const float width = std::min(kWidthInLetters * ImGui::GetFontSize(), static_cast<float>(area.width));
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(area.x) + 0.5f * static_cast<float>(area.width),
                                 static_cast<float>(area.y) + place * static_cast<float>(area.height)),
                          ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::Begin(title, nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
}

std::string timeLeft(double seconds) {
  char text[40];
  if (seconds < 90)
    std::snprintf(text, sizeof text, "%.0f s left", seconds);
  else
    std::snprintf(text, sizeof text, "%.0f min left", seconds / 60);
  return text;
}

void drawProgress(const OpeningStep& step) {
  if (step.fraction < 0) {
    // No end known: a bar that moves says that something does.
    const double phase = ImGui::GetTime();
    ImGui::ProgressBar(static_cast<float>(phase - static_cast<int>(phase)), ImVec2(-1, 0), "");
    return;
  }
  char percent[16];
  std::snprintf(percent, sizeof percent, "%.0f %%", 100 * step.fraction);
  ImGui::ProgressBar(static_cast<float>(step.fraction), ImVec2(-1, 0), percent);
}

}  // namespace

DroppedScene chooseDropped(const std::vector<std::filesystem::path>& files) {
  DroppedScene out;
  const auto found = std::find_if(files.begin(), files.end(), core::isNamedAsScene);
  if (found == files.end()) {
    out.message = (files.empty() ? std::string("nothing") : files.front().filename().string()) +
                  " is no scene: drop a .glb, .gltf or .obj file";
    return out;
  }
  out.scene = *found;
  if (files.size() > 1)
    out.message = "of " + std::to_string(files.size()) + " files " + found->filename().string() +
                  " is opened: one scene at a time";
  return out;
}

std::optional<std::filesystem::path> drawStartScreen(const std::vector<std::filesystem::path>& recent,
                                                     const render::PixelRect& area, UiItems& items) {
  std::optional<std::filesystem::path> chosen;
  beginCentred("Saccade", area, 0.4f);
  ImGui::TextWrapped("Drop a scene here: a .glb, .gltf or .obj file.");
  items.note("drop here");
  if (!recent.empty()) {
    ImGui::Separator();
    ImGui::TextUnformatted("Opened lately");
  }
  for (std::size_t i = 0; i < recent.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Button(recent[i].filename().string().c_str(), ImVec2(-1, 0))) chosen = recent[i];
    items.note("recent " + std::to_string(i));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", recent[i].string().c_str());
    ImGui::PopID();
  }
  ImGui::End();
  return chosen;
}

bool drawOpening(const SceneOpener::State& state, const render::PixelRect& area, UiItems& items) {
  beginCentred("Opening", area, 0.75f);
  ImGui::TextWrapped("%s", std::filesystem::path(state.scene).filename().string().c_str());
  drawProgress(state.step);
  items.note("progress");
  const std::string left =
      state.step.secondsLeft >= 0 ? ", " + timeLeft(state.step.secondsLeft) : std::string();
  ImGui::TextWrapped("%s%s", state.step.what.c_str(), left.c_str());
  const bool cancel = ImGui::Button(state.cancelled ? "ending ..." : "Cancel") && !state.cancelled;
  items.note("cancel");
  ImGui::End();
  return cancel;
}

bool drawNotice(const std::string& text, const render::PixelRect& area, UiItems& items) {
  beginCentred("Note", area, 0.15f);
  ImGui::TextWrapped("%s", text.c_str());
  items.note("notice");
  const bool read = ImGui::Button("OK");
  items.note("notice ok");
  ImGui::End();
  return read;
}

}  // namespace saccade::app
