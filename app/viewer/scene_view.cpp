#include "app/viewer/scene_view.h"

#include <algorithm>
#include <utility>

namespace saccade::app {

using render::Key;

namespace {

double secondsSince(SceneView::Clock::time_point start) {
  return std::chrono::duration<double>(SceneView::Clock::now() - start).count();
}

}  // namespace

SceneView::SceneView(const WalkOptions& options, std::unique_ptr<const Workspace> workspace,
                     render::Window& window)
    : options_(options),
      workspace_(std::move(workspace)),
      window_(window),
      renderer_(window.context(), workspace_->scene),
      recorder_(makeRecorder(options_, *workspace_, window.context())),
      loop_(*workspace_, renderer_,
            {options_.corrective, std::max(1, tracerThreads(options_.run)), options_.run.seed,
             options_.run.exposureEv, true}),
      home_(chooseCamera(workspace_->scene, options_.camera)),
      walker_(home_, workspace_->scene.bounds.diagonal()) {
  if (recorder_) loop_.recordTo(*recorder_);
  liveError_.emplace(tracedBy(loop_.tracer()));
  renderer_.setMaps(&workspace_->maps);
  if (!options_.path.empty()) path_ = CameraPath::read(options_.path);
  if (options_.orbit) path_ = CameraPath::orbit(home_, kOrbitPeriodSeconds);
  if (options_.keepCache) {
    kept_.emplace(*workspace_, options_.scene, options_.corrective, options_.run.seed);
    kept_->restore(loop_);
  }
}

void SceneView::keyPressed(Key key) {
  if (key == Key::home) walker_.setCamera(home_);
}

void SceneView::moveCamera(bool keysAreFree) {
  const double now = secondsSince(start_);
  const auto elapsed = static_cast<float>(now - lastMove_);
  lastMove_ = now;
  if (path_) {
    walker_.setCamera(path_->at(now));
    if (now >= path_->lengthSeconds()) path_.reset();
    return;
  }
  if (!keysAreFree) return;
  const auto axis = [this](Key plus, Key minus) {
    return static_cast<float>(window_.isDown(plus)) - static_cast<float>(window_.isDown(minus));
  };
  walker_.move({std::clamp(axis(Key::w, Key::s) + axis(Key::up, Key::down), -1.0f, 1.0f),
                std::clamp(axis(Key::d, Key::a) + axis(Key::right, Key::left), -1.0f, 1.0f),
                axis(Key::e, Key::q), window_.isDown(Key::shift)},
               elapsed);
}

void SceneView::applyPanel(const PanelState& panel) {
  loop_.setAttention(panel.attention);
  loop_.setExposure(panel.exposureEv);
  loop_.setDelta(panel.delta);
  loop_.showCorrections(panel.corrections);
  loop_.reuseSamples(panel.reuse);
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
  if (!panel.overlay) return loop_.display();
  overlay_ = aovPicture(*panel.overlay, aovValues(*panel.overlay, loop_), options_.corrective.maxAge);
  return overlay_;
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
