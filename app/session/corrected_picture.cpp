#include "app/session/corrected_picture.h"

#include <utility>

#include "core/composite.h"

namespace saccade::app {

CorrectedPicture::CorrectedPicture(const core::Scene& scene, render::BaseRenderer& renderer,
                                   const PictureSettings& settings, RunStats& stats, std::size_t probesAFrame)
    : scene_(scene),
      renderer_(renderer),
      settings_(settings),
      stats_(stats),
      probesAFrame_(probesAFrame),
      cache_(static_cast<std::size_t>(settings.cacheMb) << 20) {}

bool CorrectedPicture::shows(const core::Camera& camera, ImageSize size) const {
  return frame_ && frame_->view.camera().samePicture(camera) && frame_->view.width() == size.width &&
         frame_->view.height() == size.height;
}

void CorrectedPicture::begin(const core::Camera& camera, ImageSize size) {
  const core::View view(camera, size.width, size.height, scene_.bounds);
  const bool resumed = drawResumed(view);
  if (!resumed) {
    age(view);
    draw(view);
  }
  warp();
  toTrace_ = frame_;
  if (resumed) showExact();
}

void CorrectedPicture::age(const core::View& view) {
  const StageTimer timer(stats_, "age");
  stats_.samplesDropped +=
      cache_.age(view, {settings_.nMin, settings_.delta, settings_.maxAge, settings_.aging}).deleted;
}

void CorrectedPicture::draw(const core::View& view) {
  const StageTimer timer(stats_, "draw");
  frame_ = renderer_.render(view, cache_.cameraAge(), settings_.nMin);
}

void CorrectedPicture::warp() {
  const StageTimer timer(stats_, "warp");
  layer_.beginFrame(frame_);
  reused_ = false;
  if (!settings_.reuse) return;
  const render::SampleCache::WarpResult warped = cache_.warp(*frame_, layer_);
  stats_.samplesReused += warped.splatted;
  stats_.samplesDropped += warped.dropped;
  reused_ = warped.splatted > 0;
}

core::KnownLevels CorrectedPicture::known() {
  if (!reused_) return nullptr;
  const StageTimer timer(stats_, "warp");
  return std::make_shared<const std::vector<std::uint8_t>>(layer_.levels());
}

/// After resume(): draws the frame without aging. False where it is not the one that the visit ended with.
bool CorrectedPicture::drawResumed(const core::View& view) {
  const std::optional<VisitEnd> end = std::exchange(resumed_, std::nullopt);
  if (!end || !settings_.reuse || end->aging != agingHash(settings_) ||
      !end->samePicture({view.camera(), {view.width(), view.height()}}))
    return false;
  draw(view);
  return maskHash(*frame_) == end->mask;
}

/// Shows the cache's samples of this very frame, which are exact.
void CorrectedPicture::showExact() {
  cache_.forEach([this](const core::Sample& sample, std::uint64_t age) {
    if (age == frame_->epoch) layer_.splat(sample);
  });
  stats_.samplesResumed = layer_.exactCount();
  toTrace_ = maskedFrame(*frame_, [this](int x, int y) { return !layer_.isExact(x, y); });
}

VisitEnd CorrectedPicture::visitEnd() const {
  const core::View& view = frame_->view;
  return {view.camera(), {view.width(), view.height()}, agingHash(settings_), maskHash(*frame_)};
}

void CorrectedPicture::take(const core::SampleBatch& batch) {
  if (batch.epoch == frame_->epoch) {
    for (const core::Sample& sample : batch.samples) {
      layer_.splat(sample);
      ++stats_.levels[sample.level];
      stats_.fromDepth += sample.fromDepth ? 1 : 0;
    }
    stats_.samplesTraced += batch.samples.size();
  }
  cache_.add(batch, batch.epoch);
}

void CorrectedPicture::composite() {
  approximate();
  const StageTimer timer(stats_, "composite");
  if (!display_ || displayIsShared_) display_ = std::make_shared<core::ImageRgba8>();
  displayIsShared_ = false;
  core::compositeDisplay(frame_->view.width(), frame_->view.height(), frame_->baseAndId, corrections(),
                         settings_.exposureEv, *display_);
  core::compositeDisplayAt(bare_, frame_->baseAndId, approximated_, settings_.exposureEv, *display_);
}

/// Empty where they are off.
std::span<const core::Vec4> CorrectedPicture::corrections() {
  return settings_.corrections ? layer_.pixels() : std::span<const core::Vec4>{};
}

void CorrectedPicture::listBare() {
  bare_.clear();
  if (settings_.approximation && settings_.corrections) layer_.listUncovered(bare_);
}

void CorrectedPicture::drawProbes() {
  listBare();
  if (bare_.empty()) return;
  if (!approximation_) approximation_.emplace(scene_, renderer_);
  const StageTimer timer(stats_, "probes");
  approximation_->prepare(*frame_, bare_, probesAFrame_);
}

/// What stands in for the corrections of what is bare now.
void CorrectedPicture::approximate() {
  listBare();
  approximated_.clear();
  if (!approximation_) bare_.clear();  // no probe is drawn yet
  if (bare_.empty()) return;
  const StageTimer timer(stats_, "approximate");
  approximation_->at(*frame_, bare_, approximated_);
}

std::shared_ptr<const core::ImageRgba8> CorrectedPicture::shareDisplay() {
  displayIsShared_ = true;
  return display_;
}

core::ImageRgb CorrectedPicture::linear() {
  core::ImageRgb sum =
      core::compositeLinear(frame_->view.width(), frame_->view.height(), frame_->baseAndId, corrections());
  approximate();
  for (std::size_t i = 0; i < bare_.size(); ++i) sum.at(bare_[i].x, bare_[i].y) += approximated_[i];
  return sum;
}

}  // namespace saccade::app
