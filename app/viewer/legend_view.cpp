#include "app/viewer/legend_view.h"

#include <imgui/imgui.h>

#include <cmath>

namespace saccade::app {

namespace {

constexpr int kRampSteps = 64;

ImU32 packed(const core::Rgba8& c) { return IM_COL32(c.r, c.g, c.b, 255); }

void drawRamp(const AovScale::Ramp& ramp, const AovScale& scale) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (int i = 0; i < kRampSteps; ++i) {
    const float place = static_cast<float>(i) / (kRampSteps - 1);
    const float value = ramp.logarithmic ? ramp.low * std::pow(ramp.high / ramp.low, place)
                                         : ramp.low + (ramp.high - ramp.low) * place;
    const float left = corner.x + width * static_cast<float>(i) / kRampSteps;
    list.AddRectFilled({left, corner.y},
                       {corner.x + width * static_cast<float>(i + 1) / kRampSteps, corner.y + height},
                       packed(scale.color(value)));
  }
  ImGui::Dummy({width, height});
  ImGui::TextUnformatted(ramp.lowLabel.c_str());
  ImGui::SameLine(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(ramp.highLabel.c_str()).x);
  ImGui::TextUnformatted(ramp.highLabel.c_str());
}

void drawSwatch(const core::Rgba8& color, const char* label) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float side = ImGui::GetFontSize();
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side}, packed(color));
  ImGui::GetWindowDrawList()->AddRect(at, {at.x + side, at.y + side}, IM_COL32(110, 110, 120, 255));
  ImGui::Dummy({side, side});
  ImGui::SameLine();
  ImGui::TextUnformatted(label);
}

}  // namespace

void drawLegend(const AovLegend& legend, const AovScale& scale) {
  ImGui::TextWrapped("%s", legend.meaning);
  if (legend.ramp) drawRamp(*legend.ramp, scale);
  for (const AovLegend::Swatch& swatch : legend.swatches) drawSwatch(swatch.color, swatch.label.c_str());
  if (legend.leftOut > 0) ImGui::Text("and %zu more", legend.leftOut);
  if (legend.black[0] != '\0') drawSwatch({}, legend.black);
}

}  // namespace saccade::app
