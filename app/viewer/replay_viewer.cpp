#include "app/viewer/replay_viewer.h"

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <variant>

#include "app/cli/console.h"
#include "app/recording/session_replay.h"
#include "app/session/headless.h"
#include "core/error.h"
#include "core/image_io.h"
#include "render/window/presenter.h"
#include "render/window/window.h"

namespace saccade::app {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll{5};

/// One window's life. Members are in the order in which they depend on one another.
class ReplayViewer {
 public:
  ReplayViewer(const ReplayOptions& options, SessionReader& session, const Workspace& workspace)
      : options_(options),
        session_(session),
        window_(session.peek()->size.width, session.peek()->size.height, "Saccade: " + options.file),
        renderer_(window_.context(), workspace.scene),
        presenter_(window_.context()),
        replay_(session, workspace.scene, renderer_) {
    renderer_.setMaps(&workspace.maps);
    while (session_.peek() && session_.peek()->seconds < options.fromSeconds && replay_.next()) {
    }
    seconds_ = session_.peek() ? session_.peek()->seconds : 0;
    last_ = start_ = Clock::now();
  }

  void run() {
    const std::stop_token stop = interruptToken();
    while (open_ && !stop.stop_requested() && !timeUp()) {
      for (const render::Event& event : window_.pollEvents())
        std::visit([this](const auto& e) { handle(e); }, event);
      advance();
      if (session_.peek() && session_.peek()->seconds <= seconds_) {
        // Each frame needs the one before; what is late is not shown.
        while (session_.peek() && session_.peek()->seconds <= seconds_ && replay_.next()) {
        }
      } else {
        std::this_thread::sleep_for(kPoll);
      }
      present(false);
    }
    if (!options_.uiScreenshot.empty()) present(true);
    printWarnings(replay_.warnings());
  }

 private:
  bool timeUp() const {
    return options_.exitAfterSeconds &&
           std::chrono::duration<double>(Clock::now() - start_).count() >= *options_.exitAfterSeconds;
  }

  void advance() {
    const Clock::time_point now = Clock::now();
    if (!halted_) seconds_ += options_.speed * std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

  void present(bool screenshot) {
    if (replay_.frames() == 0) return;
    window_.bind();
    presenter_.present(replay_.display(), {0, 0, window_.width(), window_.height()}, window_.width(),
                       window_.height());
    if (screenshot) core::writePng(options_.uiScreenshot, window_.screenshot());
    window_.swap();
  }

  void handle(const render::KeyEvent& e) {
    if (!e.pressed || e.repeat) return;
    if (e.key == render::Key::escape) open_ = false;
    if (e.key == render::Key::space) halted_ = !halted_;
    if (e.key == render::Key::f11) window_.setFullscreen(!window_.fullscreen());
  }
  void handle(const render::CloseEvent&) { open_ = false; }
  template <class Event>
  void handle(const Event&) {}

  const ReplayOptions& options_;
  SessionReader& session_;
  render::Window window_;
  render::BaseRenderer renderer_;
  render::Presenter presenter_;
  SessionReplay replay_;
  bool open_ = true;
  bool halted_ = false;
  double seconds_ = 0;  ///< of the session, now
  Clock::time_point start_, last_;
};

}  // namespace

int runReplayViewer(const ReplayOptions& options) {
  SessionReader session(options.file);
  if (!session.peek()) throw core::Error(options.file + ": holds no frame; record the session again");
  const auto workspace = openRecorded(session, options.sceneFile, options.mapsFile);
  render::setSoftwareRasterThreads(rasterThreads(0));
  ReplayViewer(options, session, *workspace).run();
  return 0;
}

}  // namespace saccade::app
