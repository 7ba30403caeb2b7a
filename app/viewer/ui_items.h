// Where the window's controls are, by name: what a test clicks on.
#pragma once

#include <map>
#include <string>

#include "render/window/presenter.h"

namespace saccade::app {

/// Of one frame. Main thread only.
class UiItems {
 public:
  void clear() { items_.clear(); }
  /// After an ImGui item, between ImguiLayer::newFrame and render: that is where it is.
  void note(const std::string& name);
  /// Framebuffer pixels, y down; empty for what is not shown.
  render::PixelRect at(const std::string& name) const;
  const std::map<std::string, render::PixelRect>& all() const { return items_; }

 private:
  std::map<std::string, render::PixelRect> items_;
};

}  // namespace saccade::app
