#include "app/viewer/base_view.h"

#include "core/composite.h"
#include "core/error.h"

namespace saccade::app {

BaseView::BaseView(const SceneOpener::Reading& reading, render::GlContext& context)
    : reading_(reading), context_(context) {}

/// Throws core::Error where the scene has no such camera, too: before anything is uploaded.
void BaseView::begin() {
  const Workspace& workspace = *reading_.workspace;
  camera_ = chooseCamera(workspace.scene, reading_.visit.camera);
  upload_ =
      std::make_unique<render::BaseUpload>(context_, workspace.scene, *reading_.drawList, &workspace.maps);
}

bool BaseView::upload(std::chrono::steady_clock::time_point until) {
  if (done()) return true;
  try {
    if (!upload_) begin();
    if (!upload_->goOn(until)) return false;
    renderer_ = upload_->take();
  } catch (const core::Error& e) {
    error_ = e.what();
  }
  upload_.reset();
  return true;
}

const core::ImageRgba8& BaseView::picture(ImageSize size, float exposureEv) {
  if (!renderer_ ||
      (exposureEv_ == exposureEv && picture_.width() == size.width && picture_.height() == size.height))
    return picture_;
  const core::View view(camera_, size.width, size.height, reading_.workspace->scene.bounds);
  const core::FramePtr frame = renderer_->render(view, 1, reading_.visit.corrective.nMin);
  core::compositeDisplay(size.width, size.height, frame->baseAndId, {}, exposureEv, picture_);
  exposureEv_ = exposureEv;
  return picture_;
}

}  // namespace saccade::app
