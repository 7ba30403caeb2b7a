#include "app/viewer/scene_opener.h"

#include <exception>
#include <filesystem>
#include <utility>

namespace saccade::app {

namespace {

std::string nameOf(const WalkOptions& visit) {
  return std::filesystem::path(visit.scene.path).filename().string();
}

/// An open scene that nobody wants any more.
void refuse(SceneOpener::Outcome& outcome) {
  outcome.workspace.reset();
  outcome.cancelled = true;
  outcome.error = nameOf(outcome.visit) + ": stopped on request";
}

}  // namespace

SceneOpener::SceneOpener(Open open)
    : open_(std::move(open)), thread_([this](const std::stop_token& end) { work(end); }) {}

SceneOpener::~SceneOpener() { end(); }

void SceneOpener::open(const WalkOptions& visit) {
  {
    const std::lock_guard lock(mutex_);
    if (current_) cancel_.request_stop();
    next_ = visit;
    outcome_.reset();
  }
  asked_.notify_one();
}

void SceneOpener::cancel() {
  const std::lock_guard lock(mutex_);
  next_.reset();
  if (outcome_ && outcome_->workspace) {
    refuse(*outcome_);
    drawable_.reset();
  }
  if (!current_) return;
  current_->cancelled = true;
  cancel_.request_stop();
}

std::optional<SceneOpener::State> SceneOpener::state() const {
  const std::lock_guard lock(mutex_);
  if (next_) return State{next_->scene.path, {"waiting for the scene before"}, false};
  if (outcome_ && outcome_->workspace)
    return State{outcome_->visit.scene.path, {"handing it to OpenGL"}, false};
  return current_;
}

std::optional<SceneOpener::Reading> SceneOpener::drawable() const {
  const std::lock_guard lock(mutex_);
  return next_ || (current_ && current_->cancelled) ? std::nullopt : drawable_;
}

bool SceneOpener::hasOutcome() const {
  const std::lock_guard lock(mutex_);
  return outcome_.has_value();
}

std::optional<SceneOpener::Outcome> SceneOpener::take() {
  const std::lock_guard lock(mutex_);
  if (outcome_) drawable_.reset();
  return std::exchange(outcome_, std::nullopt);
}

void SceneOpener::awaitNews(std::chrono::milliseconds atMost) {
  std::unique_lock lock(mutex_);
  if (!outcome_) news_.wait_for(lock, atMost);
}

std::optional<SceneOpener::Outcome> SceneOpener::end() {
  cancel();
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  return take();
}

void SceneOpener::work(const std::stop_token& end) {
  for (;;) {
    WalkOptions visit;
    std::stop_token stop;
    {
      std::unique_lock lock(mutex_);
      if (!asked_.wait(lock, end, [this] { return next_.has_value(); })) return;
      visit = *std::exchange(next_, std::nullopt);
      cancel_ = std::stop_source();
      stop = cancel_.get_token();
      drawable_.reset();
      current_ = State{visit.scene.path, {"starting"}, false};
    }
    Outcome outcome = openNow(visit, stop);
    const std::lock_guard lock(mutex_);
    current_.reset();
    if (!outcome.workspace) drawable_.reset();
    if (!next_) outcome_ = std::move(outcome);
    news_.notify_all();
  }
}

SceneOpener::Outcome SceneOpener::openNow(const WalkOptions& visit, const std::stop_token& stop) {
  Outcome outcome;
  outcome.visit = visit;
  try {
    const auto report = [this](const OpeningStep& step) {
      const std::lock_guard lock(mutex_);
      current_->step = step;
    };
    outcome.workspace = open_(
        visit, stop, report, [&](std::shared_ptr<const Workspace> workspace, render::DrawList drawList) {
          const std::lock_guard lock(mutex_);
          drawable_ = Reading{visit, std::move(workspace),
                              std::make_shared<const render::DrawList>(std::move(drawList))};
          news_.notify_all();
        });
  } catch (const std::exception& e) {
    outcome.error = e.what();
  }
  outcome.cancelled = stop.stop_requested();
  // Done in spite of the wish: the person has turned to something else.
  if (outcome.cancelled && outcome.workspace) {
    refuse(outcome);
  } else if (!outcome.error.empty() && outcome.error.find(nameOf(visit)) == std::string::npos) {
    outcome.error = nameOf(visit) + ": " + outcome.error;
  }
  return outcome;
}

}  // namespace saccade::app
