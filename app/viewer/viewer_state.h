// What the window is doing, for those who look at it from outside: tests that send it events.
#pragma once

#include <functional>
#include <string>

#include "app/viewer/panel.h"
#include "app/viewer/ui_items.h"
#include "core/camera.h"

namespace saccade::app {

/// Of the frame that was just shown. References hold during the call.
struct ViewerState {
  const PanelState& panel;
  const UiItems& items;       ///< what the frame's panel and windows hold
  int width = 0, height = 0;  ///< framebuffer pixels, panel included; 0 x 0 while minimised
  int panelWidth = 0;         ///< of those; 0 without a panel
  bool fullscreen = false;
  bool mouseCaptured = false;
  std::string scene;                     ///< path of the open scene; empty: none
  std::string opening;                   ///< path of the scene that is being opened; empty: none
  std::string notice;                    ///< waits to be read; empty: none
  const core::Camera* camera = nullptr;  ///< null without a scene
  const SceneTools* tools = nullptr;     ///< null without a scene
  const FrameLoop* loop = nullptr;       ///< null without a scene; no frame before its first step
};

/// Called after each frame was shown, on the main thread; also for frames of a minimised window.
using ViewerObserver = std::function<void(const ViewerState&)>;

}  // namespace saccade::app
