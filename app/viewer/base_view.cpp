#include "app/viewer/base_view.h"

#include "core/composite.h"

namespace saccade::app {

BaseView::BaseView(const WalkOptions& visit, std::shared_ptr<const Workspace> workspace,
                   render::GlContext& context)
    : camera_(visit.camera),
      nMin_(visit.corrective.nMin),
      workspace_(std::move(workspace)),
      renderer_(std::make_unique<render::BaseRenderer>(context, workspace_->scene)) {
  renderer_->setMaps(&workspace_->maps);
}

const core::ImageRgba8& BaseView::picture(ImageSize size, float exposureEv) {
  if (exposureEv_ == exposureEv && picture_.width() == size.width && picture_.height() == size.height)
    return picture_;
  const core::View view(chooseCamera(workspace_->scene, camera_), size.width, size.height,
                        workspace_->scene.bounds);
  const core::FramePtr frame = renderer_->render(view, 1, nMin_);
  core::compositeDisplay(size.width, size.height, frame->baseAndId, {}, exposureEv, picture_);
  exposureEv_ = exposureEv;
  return picture_;
}

}  // namespace saccade::app
