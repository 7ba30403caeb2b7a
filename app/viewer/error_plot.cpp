#include "app/viewer/error_plot.h"

#include <imgui/imgui.h>

#include <array>
#include <cstdio>

#include "app/viewer/log_axis.h"

namespace saccade::app {

namespace {

// Multiples of the font's size:
constexpr float kHeight = 11.5f;      // labels included
constexpr float kLabelWidth = 3.25f;  // six characters
constexpr float kLabelHeight = 1.25f;
constexpr float kZeroHeight = 1.5f;  // the row for exactly 0, above the labels
constexpr std::size_t kTicksAcross = 5, kTicksUp = 5;
constexpr ImU32 kFrameColor = IM_COL32(110, 110, 120, 255);
constexpr ImU32 kGridColor = IM_COL32(60, 60, 66, 255);
constexpr ImU32 kTextColor = IM_COL32(170, 170, 175, 255);

struct Curve {
  const char* name;
  double ErrorPoint::*value;
  ImU32 color;
};
constexpr std::array<Curve, 2> kCurves{{{"relative MSE", &ErrorPoint::relmse, IM_COL32(255, 170, 60, 255)},
                                        {"FLIP, mean", &ErrorPoint::flip, IM_COL32(90, 200, 255, 255)}}};

std::string formatted(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Where values fall on the screen. Screen rows grow downwards.
struct Plot {
  ImVec2 topLeft, bottomRight;  ///< of the logarithmic part; the row of 0 is below
  LogAxis seconds, error;

  ImVec2 at(double s, double e) const {
    const auto x = static_cast<float>(seconds.at(s)), y = static_cast<float>(error.at(e));
    const float zeroRow = bottomRight.y + kZeroHeight * ImGui::GetFontSize() / 2;
    return {topLeft.x + x * (bottomRight.x - topLeft.x),
            e > 0 ? bottomRight.y - y * (bottomRight.y - topLeft.y) : zeroRow};
  }
};

Plot plotOf(const std::vector<ErrorPoint>& points, ImVec2 corner, float width) {
  std::vector<double> seconds, errors;
  for (const ErrorPoint& p : points) {
    seconds.push_back(p.seconds);
    errors.insert(errors.end(), {p.relmse, p.flip});
  }
  const float em = ImGui::GetFontSize();
  return {{corner.x + kLabelWidth * em, corner.y + 0.3f * em},
          {corner.x + width - 0.6f * em, corner.y + (kHeight - kLabelHeight - kZeroHeight) * em},
          axisAround(seconds),
          axisAround(errors)};
}

void drawAxes(ImDrawList& list, const Plot& plot) {
  const float em = ImGui::GetFontSize();
  const float bottom = plot.bottomRight.y + kZeroHeight * em;
  for (const double tick : plot.error.ticks(kTicksUp)) {
    const float y = plot.at(plot.seconds.low, tick).y;
    list.AddLine({plot.topLeft.x, y}, {plot.bottomRight.x, y}, kGridColor);
    const std::string label = formatted("%g", tick);
    const float width = ImGui::CalcTextSize(label.c_str()).x;
    list.AddText({plot.topLeft.x - width - 4, y - em / 2}, kTextColor, label.c_str());
  }
  for (const double tick : plot.seconds.ticks(kTicksAcross)) {
    const float x = plot.at(tick, 0).x;
    list.AddLine({x, plot.topLeft.y}, {x, bottom}, kGridColor);
    const std::string label = formatted("%g s", tick);
    const float width = ImGui::CalcTextSize(label.c_str()).x;
    list.AddText({std::min(x - width / 2, plot.bottomRight.x - width + 6), bottom + 1}, kTextColor,
                 label.c_str());
  }
  list.AddText({plot.topLeft.x - 0.85f * em, plot.bottomRight.y + 0.3f * em}, kTextColor, "0");
  list.AddLine({plot.topLeft.x, plot.bottomRight.y}, plot.bottomRight, kFrameColor);
  list.AddRect(plot.topLeft, {plot.bottomRight.x, bottom}, kFrameColor);
}

void drawCurve(ImDrawList& list, const Plot& plot, const std::vector<ErrorPoint>& points,
               const Curve& curve) {
  std::vector<ImVec2> line;
  line.reserve(points.size());
  for (const ErrorPoint& p : points) line.push_back(plot.at(p.seconds, p.*curve.value));
  list.AddPolyline(line.data(), static_cast<int>(line.size()), curve.color, 0, 1.5f);
  for (const ImVec2& at : line) list.AddCircleFilled(at, 2, curve.color);
}

void drawNumbers(const std::vector<ErrorPoint>& points) {
  for (const Curve& curve : kCurves) {
    const std::string value = points.empty() ? "-" : formatted("%.3g", points.back().*curve.value);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(curve.color), "%s: %s", curve.name, value.c_str());
  }
}

}  // namespace

std::string errorPlotStatus(const LiveError::State& state, bool corrections) {
  if (!state.failure.empty()) return "no curve: " + state.failure;
  if (!corrections) return "corrections are off";
  if (!state.resting) return "starts when the camera rests";
  if (state.referenceDone < 1) return formatted("reference: %.0f %%", 100 * state.referenceDone);
  if (state.points.empty()) return "measuring the first picture";
  std::string status =
      formatted(state.complete ? "converged after %.2f s" : "after %.2f s", state.points.back().seconds);
  if (state.waiting > 1)
    status += formatted("; %.0f pictures to measure", static_cast<double>(state.waiting));
  return status;
}

void drawErrorPlot(const LiveError::State& state, bool corrections) {
  ImGui::TextUnformatted("to the ray-traced picture:");
  drawNumbers(state.points);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Plot plot = plotOf(state.points, corner, width);
  drawAxes(list, plot);
  for (const Curve& curve : kCurves) drawCurve(list, plot, state.points, curve);
  ImGui::Dummy({width, kHeight * ImGui::GetFontSize()});
  ImGui::TextWrapped("%s", errorPlotStatus(state, corrections).c_str());
}

}  // namespace saccade::app
