#include "app/viewer/scene_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/session/picking.h"
#include "core/error.h"
#include "core/image_io.h"

namespace saccade::app {

using render::Key;

namespace {

double secondsSince(SceneView::Clock::time_point start) {
  return std::chrono::duration<double>(SceneView::Clock::now() - start).count();
}

}  // namespace

SceneView::SceneView(const WalkOptions& options, std::shared_ptr<const Workspace> workspace,
                     std::unique_ptr<render::BaseRenderer> renderer, render::Window& window)
    : options_(options),
      workspace_(std::move(workspace)),
      window_(window),
      renderer_(std::move(renderer)),
      recorder_(makeRecorder(options_, *workspace_, window.context())),
      loop_(*workspace_, *renderer_,
            {options_.corrective, std::max(1, tracerThreads(options_.run)), options_.run.seed,
             options_.run.exposureEv, true}),
      home_(chooseCamera(workspace_->scene, options_.camera)),
      walker_(home_, workspace_->scene.bounds.diagonal()),
      tools_(workspace_->scene),
      overlay_(loop_, workspace_->scene, options_.corrective.maxAge) {
  if (recorder_) loop_.recordTo(*recorder_);
  liveError_.emplace(tracedBy(loop_.tracer()));
  if (!options_.path.empty()) tools_.play(CameraPath::read(options_.path), 0);
  if (options_.orbit) tools_.play(CameraPath::orbit(home_, kOrbitPeriodSeconds), 0);
  if (options_.keepCache) {
    kept_.emplace(*workspace_, options_.scene, options_.corrective, options_.run.seed);
    kept_->restore(loop_);
  }
}

void SceneView::keyPressed(Key key) {
  if (key == Key::home) tools_.flyTo(home_, walker_.camera(), secondsSince(start_));
}

void SceneView::look(const core::Vec2& deltaPx) {
  tools_.release();
  walker_.look(deltaPx.x, deltaPx.y);
}

void SceneView::click(const core::Vec2& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x)), y = static_cast<int>(std::floor(pixel.y));
  const core::FramePtr& frame = loop_.layer().frame();
  if (!frame || x < 0 || y < 0 || x >= frame->view.width() || y >= frame->view.height()) return;
  tools_.setPicked(pick(*frame, *workspace_->world, x, y));
  if (tools_.picked()) loop_.attend(tools_.picked()->id);
}

void SceneView::moveCamera(bool keysAreFree) {
  const double now = secondsSince(start_);
  const auto elapsed = static_cast<float>(now - lastMove_);
  lastMove_ = now;
  if (keysAreFree) walk(elapsed);
  if (const auto camera = tools_.camera(now)) walker_.setCamera(*camera);
  tools_.observe(walker_.camera(), now);
}

/// As the keys say; they take the camera from flights and paths.
void SceneView::walk(float elapsedSeconds) {
  const auto axis = [this](Key plus, Key minus) {
    return static_cast<float>(window_.isDown(plus)) - static_cast<float>(window_.isDown(minus));
  };
  const WalkInput input{std::clamp(axis(Key::w, Key::s) + axis(Key::up, Key::down), -1.0f, 1.0f),
                        std::clamp(axis(Key::d, Key::a) + axis(Key::right, Key::left), -1.0f, 1.0f),
                        axis(Key::e, Key::q), window_.isDown(Key::shift)};
  if (input.forward == 0 && input.right == 0 && input.up == 0) return;
  tools_.release();
  walker_.move(input, elapsedSeconds);
}

void SceneView::applyPanel(const PanelState& panel) {
  loop_.setAttention(panel.attention);
  loop_.setExposure(panel.exposureEv);
  loop_.setDelta(panel.delta);
  loop_.showCorrections(panel.corrections);
  loop_.reuseSamples(panel.reuse);
  loop_.approximate(panel.approximation);
  tools_.setLoop(panel.loopPath);
}

/// Before a step: what the last one left is a point of the curve once it is known that the camera stays. A
/// moving camera pays nothing.
void SceneView::observeRest(const PanelState& panel, ImageSize size) {
  const bool rests = loop_.rests(walker_.camera(), size);
  if (!rests) restStart_ = Clock::now();
  if (!rests || !panel.errorPlotOpen || !panel.corrections) return liveError_->reset();
  liveError_->observe(
      {loop_.layer().frame(), loop_.corrections(), pictureSeconds_, loop_.converged(), panel.exposureEv});
}

void SceneView::step(const PanelState& panel, ImageSize size, Clock::time_point deadline) {
  applyPanel(panel);
  observeRest(panel, size);
  const std::chrono::duration<double> left = deadline - Clock::now();
  if (recorder_) recorder_->setSeconds(secondsSince(start_));
  constexpr std::chrono::duration<double> kLeast{1e-3};
  loop_.step(walker_.camera(), size, FrameBudget::untilDeadline(std::max(kLeast, left)));
  pictureSeconds_ = secondsSince(restStart_);
}

const core::ImageRgba8& SceneView::shown(const PanelState& panel) {
  if (!panel.overlay) overlay_.hide();
  if (!panel.overlay && !tools_.picked()) return loop_.display();
  picture_ = loop_.display();
  if (panel.overlay) overlay_.draw(*panel.overlay, panel.overlayStrength, picture_);
  if (tools_.picked()) outline(*tools_.picked(), workspace_->scene, loop_.frame(), picture_);
  return picture_;
}

void SceneView::serve(PanelState& panel) {
  tools_.serve(std::exchange(panel.wanted, {}), walker_.camera(), secondsSince(start_));
  if (std::exchange(panel.exrWanted, false)) saveExr(panel);
  std::string message = tools_.takeMessage();
  if (!message.empty()) panel.message = std::move(message);
}

void SceneView::saveExr(PanelState& panel) {
  try {
    const std::filesystem::path file = freeFile("saccade", ".exr");
    core::writeExr(file, loop_.linear());
    panel.message = "saved " + file.string();
  } catch (const core::Error& e) {
    panel.message = e.what();
  }
}

int SceneView::end() {
  if (kept_) kept_->keep(loop_);
  return finishRecording(recorder_.get(), options_.record);
}

RunStats SceneView::stats() const {
  RunStats stats = loop_.stats();
  stats.context = window_.context().name();
  stats.renderer = window_.context().renderer();
  return stats;
}

}  // namespace saccade::app
