#include "app/viewer/viewer.h"

#include <imgui/imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "app/cli/console.h"
#include "app/session/headless.h"
#include "app/viewer/base_view.h"
#include "app/viewer/click.h"
#include "app/viewer/panel.h"
#include "app/viewer/scene_opener.h"
#include "app/viewer/scene_view.h"
#include "app/viewer/start_screen.h"
#include "app/viewer/window_settings.h"
#include "core/error.h"
#include "core/image_io.h"
#include "render/window/imgui_layer.h"
#include "render/window/presenter.h"
#include "render/window/window.h"

namespace saccade::app {

namespace {

using Clock = std::chrono::steady_clock;
using render::Key;

/// Before main, after the libraries were loaded.
const Clock::time_point kProgramStart = Clock::now();

constexpr std::chrono::milliseconds kIdlePause{20};  ///< of frames that show no scene
/// Of a frame, for the scene that is being opened: beside one in which a person walks on, and where there is
/// but Cancel to answer and every frame of the progress delays the first picture.
constexpr std::chrono::milliseconds kUploadBeside{10}, kUploadAlone{80};

double secondsBetween(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}
double secondsSince(Clock::time_point start) { return secondsBetween(start, Clock::now()); }

int panelPixels(double uiScale) { return static_cast<int>(std::lround(kPanelWidth * uiScale)); }

std::shared_ptr<const Workspace> openVisit(const WalkOptions& visit, const std::stop_token& stop,
                                           const OpeningReport& report,
                                           const SceneOpener::Drawable& drawable) {
  const std::shared_ptr<Workspace> workspace = readWorkspace(visit.scene, bakeOf(visit), stop, report);
  drawable(workspace, render::makeDrawList(workspace->scene));
  finishWorkspace(*workspace, stop, report);
  return workspace;
}

/// One window's life, whichever scenes it shows. Members are in the order in which they depend on one
/// another.
class Viewer {
 public:
  /// `kept`: from `settings`. `opener`: opens the scene that was asked for already, if one was.
  Viewer(const WalkOptions& options, const ViewerObserver& afterFrame, SettingsFile& settings,
         KeptSettings kept, double uiScale, SceneOpener& opener)
      : options_(options),
        afterFrame_(afterFrame),
        settings_(settings),
        kept_(std::move(kept)),
        panel_(firstPanel(options, kept_)),
        uiScale_(uiScale),
        window_(firstSize().width, firstSize().height, "Saccade"),
        presenter_(window_.context()),
        imgui_(window_, static_cast<float>(uiScale_)),
        opener_(opener) {
    if (kept_.fullscreen && !options.given.size) window_.setFullscreen(*kept_.fullscreen);
    startLook_ = look();
  }

  /// Returns the exit status.
  int run() {
    const std::stop_token stop = interruptToken();
    while (!closing_) {
      closing_ = !open_ || timeIsUp() || stop.stop_requested();  // one more frame then, for the screenshot
      frame();
    }
    if (const auto outcome = opener_.end()) tell(*outcome);
    if (scene_ && !options_.run.statsFile.empty()) {
      RunStats stats = scene_->stats();
      stats.firstFrameMs = firstFrameMs_;
      stats.firstWalkMs = firstWalkMs_;
      stats.longestWaitMs = longestWaitMs_;
      writeStats(options_.run.statsFile, stats);
    }
    endScene();
    settings_.change([this](KeptSettings& kept) { keepChanges(kept, startLook_, look()); });
    return status_;
  }

 private:
  /// Panel included.
  ImageSize firstSize() const {
    if (kept_.window && !options_.given.size) return *kept_.window;
    return {options_.size.width + panelPixels(uiScale_), options_.size.height};
  }
  WindowLook look() const {
    const auto [width, height] = window_.windowedSize();
    return {{width, height}, window_.fullscreen(), panel_};
  }

  void frame() {
    const Clock::time_point start = Clock::now();
    if (std::exchange(fullscreenChanges_, false)) window_.setFullscreen(!window_.fullscreen());
    noteWait(start);
    const std::vector<render::Event> events = window_.pollEvents();
    // Before the events: whether the panel wants the mouse then depends on where it is now.
    imgui_.newFrame(window_.width(), window_.height());
    for (const render::Event& event : events) std::visit([this](const auto& e) { handle(e); }, event);
    goOnOpening();
    if (scene_) scene_->moveCamera(!ImGui::GetIO().WantCaptureKeyboard);
    const ImageSize size{window_.width() - panelWidth(), window_.height()};
    if (size.width < 1 || size.height < 1) {  // minimised, or narrower than the panel
      std::this_thread::sleep_for(kIdlePause);
      imgui_.render();
    } else {
      drawFrame(size, start);
    }
    if (afterFrame_) afterFrame_(state());
  }

  void drawFrame(ImageSize size, Clock::time_point start) {
    if (!scene_ && !uploading_) opener_.awaitNews(kIdlePause);
    const std::chrono::duration<double> budget(1 / panel_.fps - presentSeconds_);
    if (scene_) scene_->step(panel_, size, start + std::chrono::duration_cast<Clock::duration>(budget));
    const Clock::time_point stepped = Clock::now();
    present(size);
    const double presented = secondsSince(stepped);
    presentSeconds_ = 0.8 * presentSeconds_ + 0.2 * presented;
    times_.add(scene_ ? &scene_->loop().stats().stageMs : nullptr, 1000 * presented,
               1000 * secondsSince(start));
  }

  void present(ImageSize size) {
    const core::ImageRgba8& shown = scene_ ? scene_->shown(panel_) : firstPicture(size);
    window_.bind();
    presenter_.present(shown, {0, 0, size.width, size.height}, window_.width(), window_.height());
    items_.clear();
    drawPanels(size);
    imgui_.render();
    if (closing_ && !options_.uiScreenshot.empty())
      core::writePng(options_.uiScreenshot, window_.screenshot());
    if (std::exchange(panel_.screenshotWanted, false) && scene_) saveScreenshot(shown);
    window_.swap();
    if (!shown.empty() && firstFrameMs_ == 0) firstFrameMs_ = 1000 * secondsSince(kProgramStart);
    if (scene_ && firstWalkMs_ == 0) firstWalkMs_ = 1000 * secondsSince(kProgramStart);
    if (scene_) scene_->serve(panel_);
  }

  /// Of the scene that is being opened, where no other is: its base layer, or nothing yet.
  const core::ImageRgba8& firstPicture(ImageSize size) {
    static const core::ImageRgba8 kNothing;
    return ahead_ ? ahead_->picture(size, panel_.exposureEv) : kNothing;
  }

  /// Uploads a little of what is being opened, while its world is built; shows it once both are done.
  void goOnOpening() {
    const bool opened = opener_.hasOutcome();  // asked first: then what is drawable now is that
    const std::optional<SceneOpener::Reading> reading = opener_.drawable();
    if (!reading) ahead_.reset();
    if (reading && (!ahead_ || ahead_->workspace() != reading->workspace))
      ahead_.emplace(*reading, window_.context());
    uploading_ = ahead_ && !ahead_->done();
    if (uploading_ && !ahead_->upload(Clock::now() + (scene_ ? kUploadBeside : kUploadAlone))) return;
    if (!opened) return;
    if (auto outcome = opener_.take()) show(*outcome);
  }

  /// How long the window answers nobody at most while it opens a scene: from one look at the events to the
  /// next.
  void noteWait(Clock::time_point now) {
    if (wasOpening_) longestWaitMs_ = std::max(longestWaitMs_, 1000 * secondsBetween(lastEvents_, now));
    wasOpening_ = opener_.state().has_value();
    lastEvents_ = now;
  }

  /// Counts from the first scene on, or from there being none to wait for.
  bool timeIsUp() {
    if (!scene_ && opener_.state()) start_ = Clock::now();
    return options_.exitAfterSeconds && secondsSince(start_) >= *options_.exitAfterSeconds;
  }

  void show(SceneOpener::Outcome& outcome) {
    if (!outcome.workspace) return tell(outcome);
    const std::string scene = outcome.visit.scene.path;
    outcome.error = ahead_->error();
    std::unique_ptr<render::BaseRenderer> renderer = ahead_->takeRenderer();
    ahead_.reset();
    if (!renderer) return tell(outcome);
    endScene();  // not before the new one is known to fit the graphics memory
    status_ = 0;
    try {
      scene_.emplace(outcome.visit, std::move(outcome.workspace), std::move(renderer), window_);
    } catch (const core::Error& e) {
      outcome.error = e.what();
      return tell(outcome);
    }
    window_.setTitle("Saccade: " + scene);
    settings_.change([&](KeptSettings& kept) {
      addRecent(kept, scene);
      kept_.recent = kept.recent;
    });
  }

  /// Where there is no scene, the walk that was asked for has failed.
  void tell(const SceneOpener::Outcome& outcome) {
    notice_ = outcome.error;
    spdlog::log(outcome.cancelled && scene_ ? spdlog::level::info : spdlog::level::err, "{}", outcome.error);
    if (!scene_) status_ = 1;
  }

  void endScene() {
    if (!scene_) return;
    status_ = std::max(status_, scene_->end());
    scene_.reset();
  }

  void open(const std::filesystem::path& scene) {
    notice_.clear();
    opener_.open(laterVisit(options_, scene));
  }

  void drawOpenings(ImageSize size) {
    const render::PixelRect area{0, 0, size.width, size.height};
    const std::optional<SceneOpener::State> opening = opener_.state();
    if (!scene_ && !opening) {
      if (const auto chosen = drawStartScreen(kept_.recent, area, items_)) open(*chosen);
    }
    if (opening && drawOpening(*opening, area, items_)) opener_.cancel();
    if (!notice_.empty() && drawNotice(notice_, area, items_)) notice_.clear();
  }

  void drawPanels(ImageSize size) {
    drawOpenings(size);
    if (!scene_) return;
    const LiveError::State error = scene_->error();
    drawPanel(panel_, {.notes = scene_->workspace().scene.warnings,
                       .loop = scene_->loop(),
                       .times = times_,
                       .error = error,
                       .tools = scene_->tools(),
                       .overlay = scene_->overlay(),
                       .area = {size.width, 0, panelWidth(), window_.height()},
                       .items = items_});
  }

  void saveScreenshot(const core::ImageRgba8& image) {
    try {
      const std::filesystem::path file = freeFile("saccade", ".png");
      core::writePng(file, image);
      panel_.message = "saved " + file.string();
    } catch (const core::Error& e) {
      panel_.message = e.what();
    }
  }

  int panelWidth() const {
    return (scene_ || (ahead_ && ahead_->ready())) && panel_.visible ? panelPixels(uiScale_) : 0;
  }

  ViewerState state() const {
    ViewerState state{panel_, items_};
    state.width = window_.width();
    state.height = window_.height();
    state.panelWidth = panelWidth();
    state.fullscreen = window_.fullscreen();
    state.mouseCaptured = window_.mouseCaptured();
    if (const auto opening = opener_.state()) state.opening = opening->scene;
    state.notice = notice_;
    if (scene_) {
      state.scene = scene_->workspace().scene.path;
      state.camera = &scene_->camera();
      state.tools = &scene_->tools();
      state.loop = &scene_->loop();
    }
    return state;
  }

  void handle(const render::KeyEvent& e) {
    if (!e.pressed || e.repeat) return;
    switch (e.key) {
      case Key::f1:
        panel_.showKeys = !panel_.showKeys;
        break;
      case Key::f11:
        fullscreenChanges_ = true;
        break;
      case Key::f12:
        (window_.isDown(Key::shift) ? panel_.exrWanted : panel_.screenshotWanted) = true;
        break;
      case Key::l:
        panel_.loopPath = !panel_.loopPath;
        break;
      case Key::tab:
        panel_.visible = !panel_.visible;
        break;
      case Key::c:
        panel_.corrections = !panel_.corrections;
        break;
      case Key::r:
        panel_.reuse = !panel_.reuse;
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
        chooseOverlay(static_cast<int>(e.key) - static_cast<int>(Key::digit1));
    }
    request(e.key, window_.isDown(Key::control), panel_.wanted);
    if (scene_) scene_->keyPressed(e.key);
  }
  void chooseOverlay(int number) {
    if (number >= 0 && number < static_cast<int>(aovNames().size()))
      panel_.overlay = static_cast<Aov>(number);
  }
  void handle(const render::MouseButtonEvent& e) {
    const bool free = !window_.mouseCaptured() && !ImGui::GetIO().WantCaptureMouse;
    if (e.button == render::MouseButton::left && e.pressed && free) leftButton_.press();
    if (e.button == render::MouseButton::left && !e.pressed && leftButton_.release() && scene_)
      scene_->click(e.positionPx);
    if (e.button != render::MouseButton::right || !e.pressed || ImGui::GetIO().WantCaptureMouse) return;
    window_.setMouseCaptured(!window_.mouseCaptured());
  }
  void handle(const render::MouseMoveEvent& e) {
    leftButton_.move(e.deltaPx);
    const bool dragging = window_.isDown(render::MouseButton::left) && !ImGui::GetIO().WantCaptureMouse;
    if (scene_ && (window_.mouseCaptured() || dragging)) scene_->look(e.deltaPx);
  }
  void handle(const render::ScrollEvent& e) {
    if (scene_ && !ImGui::GetIO().WantCaptureMouse) scene_->zoom(e.amount.y);
  }
  void handle(const render::CloseEvent&) { open_ = false; }
  void handle(const render::ResizeEvent&) {}  // the size is asked for every frame
  void handle(const render::DropEvent& e) {
    const DroppedScene dropped = chooseDropped(e.files);
    if (dropped.scene) open(*dropped.scene);
    notice_ = dropped.message;
  }

  const WalkOptions& options_;
  const ViewerObserver& afterFrame_;
  SettingsFile& settings_;
  KeptSettings kept_;
  PanelState panel_;
  double uiScale_;  ///< of letters and panel: 1 on a display of about 96 dots an inch
  render::Window window_;
  render::Presenter presenter_;
  render::ImguiLayer imgui_;
  WindowLook startLook_;
  SceneOpener& opener_;
  std::optional<BaseView> ahead_;   ///< of the scene that is being opened, once scene and maps are there
  bool uploading_ = false;          ///< in this frame: the next one comes without a pause
  std::optional<SceneView> scene_;  ///< nothing: none is open
  std::string notice_;              ///< waits to be read; empty: nothing
  int status_ = 0;                  ///< of the program
  double firstFrameMs_ = 0, firstWalkMs_ = 0, longestWaitMs_ = 0;
  Clock::time_point lastEvents_;  ///< were looked at
  bool wasOpening_ = false;       ///< then
  UiItems items_;
  StageTimes times_;
  ClickDetector leftButton_;
  bool fullscreenChanges_ = false;  ///< before the next frame: this one has begun
  bool open_ = true;
  bool closing_ = false;  ///< this frame is the last
  Clock::time_point start_ = Clock::now();
  double presentSeconds_ = 0;  ///< running mean of what comes after the frame loop, kept free of its budget
};

}  // namespace

int runViewer(const WalkOptions& asked, const ViewerObserver& afterFrame) {
  SettingsFile settings;
  KeptSettings kept = settings.load();
  const WalkOptions options = withKept(asked, kept);
  render::setSoftwareRasterThreads(rasterThreads(std::max(1, tracerThreads(options.run))));
  // Asked in any case: without a display nothing is to be read.
  const double displayScale = render::displayScale();
  SceneOpener opener(openVisit);
  if (!options.scene.path.empty()) opener.open(options);  // read while the window comes up
  return Viewer(options, afterFrame, settings, std::move(kept), options.uiScale.value_or(displayScale),
                opener)
      .run();
}

}  // namespace saccade::app
