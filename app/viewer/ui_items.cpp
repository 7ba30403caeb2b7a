#include "app/viewer/ui_items.h"

#include <imgui/imgui.h>

namespace saccade::app {

void UiItems::note(const std::string& name) {
  const ImVec2 least = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  const auto pixels = [](float x, float by) { return static_cast<int>(x * by); };
  items_[name] = {pixels(least.x, scale.x), pixels(least.y, scale.y), pixels(size.x, scale.x),
                  pixels(size.y, scale.y)};
}

render::PixelRect UiItems::at(const std::string& name) const {
  const auto found = items_.find(name);
  return found == items_.end() ? render::PixelRect{} : found->second;
}

}  // namespace saccade::app
