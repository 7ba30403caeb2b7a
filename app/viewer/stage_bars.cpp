#include "app/viewer/stage_bars.h"

#include <imgui/imgui.h>

#include <algorithm>
#include <array>

namespace saccade::app {

namespace {

constexpr float kHeightInLines = 6;
constexpr float kHeadroom = 1.6f;  ///< of the plot over the budget
constexpr ImU32 kBudgetColor = IM_COL32(255, 90, 90, 255);
constexpr ImU32 kFrameColor = IM_COL32(110, 110, 120, 255);

ImU32 packed(const core::Rgba8& c) { return IM_COL32(c.r, c.g, c.b, c.a); }

void drawBars(const StageTimes& times, float budgetMs, ImVec2 corner, ImVec2 size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float bottom = corner.y + size.y, pixelsPerMs = size.y / (kHeadroom * budgetMs);
  const float width = size.x / static_cast<float>(StageTimes::kShown);
  float x = corner.x + size.x - width * static_cast<float>(times.frames().size());
  for (const StageTimes::Frame& frame : times.frames()) {
    float y = bottom;
    for (std::size_t i = 0; i < frame.partMs.size() && y > corner.y; ++i) {
      const float top = std::max(corner.y, y - frame.partMs[i] * pixelsPerMs);
      if (top < y) list.AddRectFilled({x, top}, {x + width, y}, packed(StageTimes::color(i)));
      y = top;
    }
    x += width;
  }
  const float line = bottom - budgetMs * pixelsPerMs;
  list.AddLine({corner.x, line}, {corner.x + size.x, line}, kBudgetColor);
  char label[32];
  std::snprintf(label, sizeof label, "budget %.0f ms", static_cast<double>(budgetMs));
  list.AddText({corner.x + 3, line - ImGui::GetFontSize() - 1}, kBudgetColor, label);
  list.AddRect(corner, {corner.x + size.x, bottom}, kFrameColor);
}

void drawLegend(const StageTimes& times) {
  if (!ImGui::BeginTable("stages", 2)) return;
  for (std::size_t i = 0; i < times.stages().size(); ++i) {
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = 0.7f * ImGui::GetFontSize();
    const float top = at.y + 0.2f * ImGui::GetFontSize();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + side, top + side},
                                              packed(StageTimes::color(i)));
    ImGui::Dummy({side, 0});
    ImGui::SameLine();
    ImGui::Text("%s %.1f ms", times.stages()[i].c_str(), times.meanMs(i));
  }
  ImGui::EndTable();
}

}  // namespace

core::Rgba8 StageTimes::color(std::size_t stage) {
  static constexpr std::array<core::Rgba8, 10> kColors{{{150, 110, 200, 255},
                                                        {80, 140, 230, 255},
                                                        {80, 200, 200, 255},
                                                        {110, 190, 90, 255},
                                                        {230, 200, 80, 255},
                                                        {235, 140, 60, 255},
                                                        {130, 130, 130, 255},
                                                        {220, 110, 150, 255},
                                                        {170, 120, 80, 255},
                                                        {210, 210, 210, 255}}};
  return kColors[stage % kColors.size()];
}

std::size_t StageTimes::indexOf(const std::string& stage) {
  const auto found = std::find(stages_.begin(), stages_.end(), stage);
  const auto index = static_cast<std::size_t>(found - stages_.begin());
  if (found == stages_.end()) stages_.push_back(stage);
  return index;
}

void StageTimes::add(const std::map<std::string, double>* summedMs, double presentMs, double totalMs) {
  std::map<std::string, double> parts;
  if (summedMs) {
    for (const auto& [stage, sum] : *summedMs) {
      const double before = last_.count(stage) > 0 ? last_[stage] : 0;
      parts[stage] = sum - (before <= sum ? before : 0);
    }
    last_ = *summedMs;
  }
  parts[kPresent] = presentMs;
  Frame frame{totalMs, std::vector<float>(stages_.size(), 0)};
  double left = totalMs;
  for (const auto& [stage, ms] : parts) {
    const std::size_t index = indexOf(stage);
    frame.partMs.resize(stages_.size(), 0);
    frame.partMs[index] = static_cast<float>(std::clamp(ms, 0.0, left));
    left -= std::clamp(ms, 0.0, left);
  }
  frame.partMs[indexOf(kRest)] = static_cast<float>(left);
  frames_.push_back(std::move(frame));
  if (frames_.size() > kShown) frames_.pop_front();
}

double StageTimes::meanMs() const {
  double sum = 0;
  for (const Frame& frame : frames_) sum += frame.totalMs;
  return frames_.empty() ? 0 : sum / static_cast<double>(frames_.size());
}

double StageTimes::meanMs(std::size_t stage) const {
  double sum = 0;
  for (const Frame& frame : frames_) sum += stage < frame.partMs.size() ? frame.partMs[stage] : 0;
  return frames_.empty() ? 0 : sum / static_cast<double>(frames_.size());
}

void drawStageBars(const StageTimes& times, float budgetMs) {
  const double mean = times.meanMs();
  ImGui::Text("%.1f frames/s, %.1f ms a frame", mean > 0 ? 1000 / mean : 0.0, mean);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, kHeightInLines * ImGui::GetFontSize()};
  drawBars(times, budgetMs, corner, size);
  ImGui::Dummy(size);
  drawLegend(times);
}

}  // namespace saccade::app
