// The panel at the window's side: what the user sets, and what the frame loop reports. Dear ImGui 1.86, no
// docking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/frame_loop.h"
#include "app/session/live_error.h"
#include "app/session/overlays.h"

namespace saccade::app {

inline constexpr int kPanelWidth = 300;  ///< framebuffer pixels

/// What the panel changes; the viewer applies it.
struct PanelState {
  float attention = 0.5f;
  float fps = 25;
  float exposureEv = 0;
  float delta = 0.1f;
  bool corrections = true;
  bool reuse = true;
  std::optional<Aov> overlay;
  /// Error is measured only while its plot can be seen. Open at first: the work takes only time that nothing
  /// else wants, and a curve that starts when it is asked for has lost its beginning.
  bool errorPlotOpen = true;
  bool showKeys = false;
  bool screenshotWanted = false;
  std::string message;  ///< last thing done, such as the name of a screenshot
};

/// Frame times for the plot, newest last.
class FrameTimes {
 public:
  void add(float milliseconds);
  const std::vector<float>& values() const { return values_; }

 private:
  static constexpr std::size_t kShown = 150;
  std::vector<float> values_;
};

/// One line per key.
struct KeyHelp {
  const char* keys;
  const char* action;
};
const std::vector<KeyHelp>& keyHelp();

/// Between ImguiLayer::newFrame and render. The panel takes the right `kPanelWidth` pixels of the
/// framebuffer.
void drawPanel(PanelState& state, const FrameLoop& loop, const FrameTimes& times,
               const LiveError::State& error, int framebufferWidth, int framebufferHeight);

}  // namespace saccade::app
