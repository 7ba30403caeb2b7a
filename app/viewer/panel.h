// The panel at the window's side: what the user sets, and what the frame loop reports. Dear ImGui 1.86, no
// docking. All sizes are multiples of the font's, so that a larger font makes a larger panel.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/frame_loop.h"
#include "app/session/live_error.h"
#include "app/session/overlays.h"
#include "app/viewer/overlay_view.h"
#include "app/viewer/scene_tools.h"
#include "app/viewer/stage_bars.h"
#include "app/viewer/ui_items.h"
#include "render/window/presenter.h"

namespace saccade::app {

inline constexpr int kPanelWidth = 300;  ///< framebuffer pixels at a UI scale of 1

/// What the panel changes; the viewer applies it.
struct PanelState {
  float attention = 0.5f;
  float fps = 25;
  float exposureEv = 0;
  float delta = 0.1f;
  bool corrections = true;
  bool reuse = true;
  bool approximation = true;  ///< until the first samples
  std::optional<Aov> overlay;
  float overlayStrength = 1;  ///< over the picture, (0, 1]
  bool loopPath = false;
  /// Error is measured only while its plot can be seen. Open at first: the work takes only time that nothing
  /// else wants, and a curve that starts when it is asked for has lost its beginning.
  bool errorPlotOpen = true;
  bool visible = true;  ///< else the picture has the whole window
  bool showKeys = false;
  bool screenshotWanted = false;
  bool exrWanted = false;
  ToolRequests wanted;  ///< since the last frame
  std::string message;  ///< last thing done, such as the name of a screenshot
};

/// One line per key.
struct KeyHelp {
  const char* keys;
  const char* action;
};
const std::vector<KeyHelp>& keyHelp();

/// What the panel shows of the open scene, and where.
struct PanelView {
  const std::vector<std::string>& notes;  ///< what reading the scene had to say (core::Scene::warnings)
  const FrameLoop& loop;
  const StageTimes& times;
  const LiveError::State& error;
  const SceneTools& tools;
  const std::optional<ShownOverlay>& overlay;
  render::PixelRect area;  ///< framebuffer pixels; of no width while the panel is hidden
  UiItems& items;          ///< the panel's controls are noted there
};

/// Between ImguiLayer::newFrame and render.
void drawPanel(PanelState& state, const PanelView& view);

}  // namespace saccade::app
