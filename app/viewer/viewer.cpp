#include "app/viewer/viewer.h"

#include <imgui/imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>
#include <variant>

#include "app/cli/console.h"
#include "app/recording/session_recorder.h"
#include "app/session/camera_path.h"
#include "app/session/headless.h"
#include "app/session/kept_cache.h"
#include "app/session/live_error.h"
#include "app/viewer/panel.h"
#include "app/viewer/walker.h"
#include "core/image_io.h"
#include "render/window/imgui_layer.h"
#include "render/window/presenter.h"
#include "render/window/window.h"

namespace saccade::app {

namespace {

using Clock = std::chrono::steady_clock;
using render::Key;

constexpr std::chrono::milliseconds kMinimisedPause{20};

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One window's life. Members are in the order in which they depend on one another.
class Viewer {
 public:
  Viewer(const WalkOptions& options, const Workspace& workspace)
      : options_(options),
        window_(options.size.width + kPanelWidth, options.size.height, "Saccade: " + workspace.scene.path),
        renderer_(window_.context(), workspace.scene),
        presenter_(window_.context()),
        imgui_(window_),
        recorder_(makeRecorder(options, workspace, window_.context())),
        loop_(workspace, renderer_,
              {options.corrective, std::max(1, tracerThreads(options.run)), options.run.seed,
               options.run.exposureEv, true}),
        home_(chooseCamera(workspace.scene, options.camera)),
        walker_(home_, workspace.scene.bounds.diagonal()) {
    if (recorder_) loop_.recordTo(*recorder_);
    liveError_.emplace(tracedBy(loop_.tracer()));
    renderer_.setMaps(&workspace.maps);
    if (!options.path.empty()) path_ = CameraPath::read(options.path);
    if (options.orbit) path_ = CameraPath::orbit(home_, kOrbitPeriodSeconds);
    if (options.keepCache)
      kept_.emplace(workspace, options.scene, options.corrective, options.run.seed).restore(loop_);
    panel_.attention = static_cast<float>(options.corrective.attention.attention);
    panel_.fps = static_cast<float>(options.fps);
    panel_.exposureEv = options.run.exposureEv;
    panel_.delta = options.corrective.delta;
    if (!options.overlay.empty()) panel_.overlay = aovByName(options.overlay);
  }

  RunStats run() {
    const std::stop_token stop = interruptToken();
    while (!closing_) {
      const bool timeUp = options_.exitAfterSeconds && secondsSince(start_) >= *options_.exitAfterSeconds;
      closing_ = !open_ || timeUp || stop.stop_requested();  // one more frame then, for the screenshot
      frame();
    }
    if (kept_) kept_->keep(loop_);
    RunStats stats = loop_.stats();
    stats.context = window_.context().name();
    stats.renderer = window_.context().renderer();
    return stats;
  }

  SessionRecorder* recorder() { return recorder_.get(); }

 private:
  void frame() {
    const Clock::time_point start = Clock::now();
    for (const render::Event& event : window_.pollEvents()) {
      std::visit([this](const auto& e) { handle(e); }, event);
    }
    moveCamera();
    applyPanel();
    const ImageSize size{window_.width() - kPanelWidth, window_.height()};
    if (size.width < 1 || size.height < 1) {  // minimised, or narrower than the panel
      std::this_thread::sleep_for(kMinimisedPause);
      return;
    }
    observeRest(size);
    const double before = secondsSince(start);
    const double budget = std::max(1e-3, 1 / panel_.fps - before - presentSeconds_);
    if (recorder_) recorder_->setSeconds(secondsSince(start_));
    loop_.step(walker_.camera(), size, FrameBudget::untilDeadline(std::chrono::duration<double>(budget)));
    pictureSeconds_ = secondsSince(restStart_);
    const Clock::time_point shown = Clock::now();
    present(size);
    presentSeconds_ = 0.8 * presentSeconds_ + 0.2 * secondsSince(shown);
    times_.add(static_cast<float>(1000 * secondsSince(start)));
  }

  /// Before a step: what the last one left is a point of the curve once it is known that the camera stays. A
  /// moving camera pays nothing.
  void observeRest(ImageSize size) {
    const bool rests = loop_.rests(walker_.camera(), size);
    if (!rests) restStart_ = Clock::now();
    if (!rests || !panel_.errorPlotOpen || !panel_.corrections) return liveError_->reset();
    liveError_->observe(
        {loop_.layer().frame(), loop_.corrections(), pictureSeconds_, loop_.converged(), panel_.exposureEv});
  }

  void present(ImageSize size) {
    const core::ImageRgba8* shown = &loop_.display();
    core::ImageRgba8 overlay;
    if (panel_.overlay) {
      overlay = aovPicture(*panel_.overlay, aovValues(*panel_.overlay, loop_), options_.corrective.maxAge);
      shown = &overlay;
    }
    window_.bind();
    presenter_.present(*shown, {0, 0, size.width, size.height}, window_.width(), window_.height());
    imgui_.newFrame(window_.width(), window_.height());
    drawPanel(panel_, loop_, times_, liveError_->state(), window_.width(), window_.height());
    imgui_.render();
    if (closing_ && !options_.uiScreenshot.empty())
      core::writePng(options_.uiScreenshot, window_.screenshot());
    if (panel_.screenshotWanted) saveScreenshot(*shown);
    window_.swap();
  }

  void saveScreenshot(const core::ImageRgba8& image) {
    panel_.screenshotWanted = false;
    std::string name;
    for (int i = 1; name.empty() || std::filesystem::exists(name); ++i) {
      char text[32];
      std::snprintf(text, sizeof text, "saccade_%04d.png", i);
      name = text;
    }
    core::writePng(name, image);
    panel_.message = "saved " + (std::filesystem::current_path() / name).string();
  }

  void moveCamera() {
    const double now = secondsSince(start_);
    const auto elapsed = static_cast<float>(now - lastMove_);
    lastMove_ = now;
    if (path_) {
      walker_.setCamera(path_->at(now));
      if (now >= path_->lengthSeconds()) path_.reset();
      return;
    }
    if (ImGui::GetIO().WantCaptureKeyboard) return;
    const auto axis = [this](Key plus, Key minus) {
      return static_cast<float>(window_.isDown(plus)) - static_cast<float>(window_.isDown(minus));
    };
    walker_.move({std::clamp(axis(Key::w, Key::s) + axis(Key::up, Key::down), -1.0f, 1.0f),
                  std::clamp(axis(Key::d, Key::a) + axis(Key::right, Key::left), -1.0f, 1.0f),
                  axis(Key::e, Key::q), window_.isDown(Key::shift)},
                 elapsed);
  }

  void applyPanel() {
    loop_.setAttention(panel_.attention);
    loop_.setExposure(panel_.exposureEv);
    loop_.setDelta(panel_.delta);
    loop_.showCorrections(panel_.corrections);
    loop_.reuseSamples(panel_.reuse);
  }

  void handle(const render::KeyEvent& e) {
    if (!e.pressed || e.repeat) return;
    switch (e.key) {
      case Key::f1:
        panel_.showKeys = !panel_.showKeys;
        break;
      case Key::f11:
        window_.setFullscreen(!window_.fullscreen());
        break;
      case Key::f12:
        panel_.screenshotWanted = true;
        break;
      case Key::c:
        panel_.corrections = !panel_.corrections;
        break;
      case Key::r:
        panel_.reuse = !panel_.reuse;
        break;
      case Key::home:
        walker_.setCamera(home_);
        break;
      case Key::digit0:
        panel_.overlay.reset();
        break;
      case Key::escape:
        if (window_.mouseCaptured()) {
          window_.setMouseCaptured(false);
        } else {
          open_ = false;
        }
        break;
      default:
        if (e.key >= Key::digit1 && e.key <= Key::digit5) {
          panel_.overlay = static_cast<Aov>(static_cast<int>(e.key) - static_cast<int>(Key::digit1));
        }
    }
  }
  void handle(const render::MouseButtonEvent& e) {
    if (e.button != render::MouseButton::right || !e.pressed || ImGui::GetIO().WantCaptureMouse) return;
    window_.setMouseCaptured(!window_.mouseCaptured());
  }
  void handle(const render::MouseMoveEvent& e) {
    const bool dragging = window_.isDown(render::MouseButton::left) && !ImGui::GetIO().WantCaptureMouse;
    if (window_.mouseCaptured() || dragging) walker_.look(e.deltaPx.x, e.deltaPx.y);
  }
  void handle(const render::ScrollEvent& e) {
    if (!ImGui::GetIO().WantCaptureMouse) walker_.zoom(e.amount.y);
  }
  void handle(const render::CloseEvent&) { open_ = false; }
  void handle(const render::ResizeEvent&) {}  // the size is asked for every frame
  void handle(const render::DropEvent&) {
    panel_.message = "to open another scene, start saccade walk with it";
  }

  const WalkOptions& options_;
  render::Window window_;
  render::BaseRenderer renderer_;
  render::Presenter presenter_;
  render::ImguiLayer imgui_;
  std::optional<LiveError> liveError_;         ///< above the loop: its idle thread ends once the tracers have
  std::unique_ptr<SessionRecorder> recorder_;  ///< null without --record
  FrameLoop loop_;
  std::optional<KeptCache> kept_;
  core::Camera home_;
  Walker walker_;
  std::optional<CameraPath> path_;
  PanelState panel_;
  FrameTimes times_;
  bool open_ = true;
  bool closing_ = false;  ///< this frame is the last
  Clock::time_point start_ = Clock::now();
  double lastMove_ = 0;
  Clock::time_point restStart_ = start_;  ///< the camera came here
  double pictureSeconds_ = 0;             ///< from then to the end of the last step
  double presentSeconds_ = 0;  ///< running mean of what comes after the frame loop, kept free of its budget
};

}  // namespace

int runViewer(const WalkOptions& options, const Workspace& workspace) {
  render::setSoftwareRasterThreads(rasterThreads(std::max(1, tracerThreads(options.run))));
  Viewer viewer(options, workspace);
  const RunStats stats = viewer.run();
  if (!options.run.statsFile.empty()) writeStats(options.run.statsFile, stats);
  return finishRecording(viewer.recorder(), options.record);
}

}  // namespace saccade::app
