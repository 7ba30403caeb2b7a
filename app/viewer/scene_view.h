// One open scene in the window: its frame loop, the camera that walks in it, and what goes with a visit.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "app/cli/walk_options.h"
#include "app/recording/session_recorder.h"
#include "app/session/frame_loop.h"
#include "app/session/kept_cache.h"
#include "app/session/live_error.h"
#include "app/session/workspace.h"
#include "app/viewer/overlay_view.h"
#include "app/viewer/panel.h"
#include "app/viewer/scene_tools.h"
#include "app/viewer/walker.h"
#include "render/base/base_renderer.h"
#include "render/window/window.h"

namespace saccade::app {

/// GL thread only, the destructor included. The window must outlive it.
class SceneView {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes from the options camera, path, recording, kept cache and all that pictures depend on. Throws
  /// core::Error.
  /// `renderer`: of this workspace and the window's context, with the maps.
  SceneView(const WalkOptions& options, std::shared_ptr<const Workspace> workspace,
            std::unique_ptr<render::BaseRenderer> renderer, render::Window& window);
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// Input, as it arrives, that the panel does not want.
  void keyPressed(render::Key key);
  void look(const core::Vec2& deltaPx);
  /// A click on the picture, in its pixels: picks what is there.
  void click(const core::Vec2& pixel);
  void zoom(float steps) { walker_.zoom(steps); }
  /// Once a frame: along the path, else as the keys that are down say, while they are not typed into a field.
  void moveCamera(bool keysAreFree);

  /// A frame that ends, without what the window does after it, at the deadline.
  void step(const PanelState& panel, ImageSize size, Clock::time_point deadline);
  /// What the last step shows: its picture, the panel's overlay, the outline of what is picked. Valid until
  /// the next call or step.
  const core::ImageRgba8& shown(const PanelState& panel);
  /// What the panel and keys asked for; says in the panel what became of it.
  void serve(PanelState& panel);

  /// After the last step: keeps the cache and closes the recording, saying what became of it. Returns the
  /// exit status of the walk.
  int end();

  const Workspace& workspace() const { return *workspace_; }
  const FrameLoop& loop() const { return loop_; }
  const core::Camera& camera() const { return walker_.camera(); }
  const SceneTools& tools() const { return tools_; }
  /// That shown() drew, if any.
  const std::optional<ShownOverlay>& overlay() const { return overlay_.shown(); }
  LiveError::State error() const { return liveError_->state(); }
  RunStats stats() const;

 private:
  void applyPanel(const PanelState& panel);
  void observeRest(const PanelState& panel, ImageSize size);
  void walk(float elapsedSeconds);
  void saveExr(PanelState& panel);

  // In the order in which they depend on one another.
  const WalkOptions options_;
  std::shared_ptr<const Workspace> workspace_;
  render::Window& window_;
  std::unique_ptr<render::BaseRenderer> renderer_;
  std::optional<LiveError> liveError_;         ///< above the loop: its idle thread ends once the tracers have
  std::unique_ptr<SessionRecorder> recorder_;  ///< null without --record
  FrameLoop loop_;
  std::optional<KeptCache> kept_;
  core::Camera home_;
  Walker walker_;
  SceneTools tools_;
  OverlayView overlay_;
  core::ImageRgba8 picture_;  ///< with overlay and outline
  Clock::time_point start_ = Clock::now();
  double lastMove_ = 0;                   ///< seconds since start_
  Clock::time_point restStart_ = start_;  ///< the camera came here
  double pictureSeconds_ = 0;             ///< from then to the end of the last step
};

}  // namespace saccade::app
