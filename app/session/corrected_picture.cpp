#include "app/session/corrected_picture.h"

#include "core/composite.h"

namespace saccade::app {

CorrectedPicture::CorrectedPicture(const core::Scene& scene, render::BaseRenderer& renderer,
                                   const PictureSettings& settings, RunStats& stats)
    : scene_(scene),
      renderer_(renderer),
      settings_(settings),
      stats_(stats),
      cache_(static_cast<std::size_t>(settings.cacheMb) << 20) {}

bool CorrectedPicture::shows(const core::Camera& camera, ImageSize size) const {
  return frame_ && frame_->view.camera().samePicture(camera) && frame_->view.width() == size.width &&
         frame_->view.height() == size.height;
}

void CorrectedPicture::begin(const core::Camera& camera, ImageSize size) {
  const core::View view(camera, size.width, size.height, scene_.bounds);
  {
    const StageTimer timer(stats_, "age");
    stats_.samplesDropped += cache_.age(view, {settings_.nMin, settings_.delta, settings_.maxAge}).deleted;
  }
  {
    const StageTimer timer(stats_, "draw");
    frame_ = renderer_.render(view, cache_.cameraAge(), settings_.nMin);
  }
  const StageTimer timer(stats_, "warp");
  layer_.beginFrame(frame_);
  if (settings_.reuse) {
    const render::SampleCache::WarpResult warped = cache_.warp(*frame_, layer_);
    stats_.samplesReused += warped.splatted;
    stats_.samplesDropped += warped.dropped;
  }
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
  const StageTimer timer(stats_, "composite");
  if (!display_ || displayIsShared_) display_ = std::make_shared<core::ImageRgba8>();
  displayIsShared_ = false;
  const auto corrections = settings_.corrections ? layer_.pixels() : std::span<const core::Vec4>{};
  core::compositeDisplay(frame_->view.width(), frame_->view.height(), frame_->baseAndId, corrections,
                         settings_.exposureEv, *display_);
}

std::shared_ptr<const core::ImageRgba8> CorrectedPicture::shareDisplay() {
  displayIsShared_ = true;
  return display_;
}

core::ImageRgb CorrectedPicture::linear() {
  return core::compositeLinear(frame_->view.width(), frame_->view.height(), frame_->baseAndId,
                               layer_.pixels());
}

}  // namespace saccade::app
