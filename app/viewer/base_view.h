// The base layer of a scene that is still being opened: uploaded, and shown where no other scene is, while
// its ray-tracing world is built.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "app/cli/walk_options.h"
#include "app/session/workspace.h"
#include "core/image.h"
#include "render/base/base_renderer.h"

namespace saccade::app {

/// GL thread only, the destructor included. The context must outlive it.
class BaseView {
 public:
  /// Uploads; the workspace needs no world yet. Throws core::Error.
  BaseView(const WalkOptions& visit, std::shared_ptr<const Workspace> workspace, render::GlContext& context);

  const std::shared_ptr<const Workspace>& workspace() const { return workspace_; }
  /// Seen through the visit's first camera; drawn anew where size or exposure changed. Throws core::Error,
  /// also where the scene has no such camera.
  const core::ImageRgba8& picture(ImageSize size, float exposureEv);
  /// What was uploaded. Nothing else may be called afterwards.
  std::unique_ptr<render::BaseRenderer> takeRenderer() { return std::move(renderer_); }

 private:
  CameraOptions camera_;
  int nMin_;
  std::shared_ptr<const Workspace> workspace_;
  std::unique_ptr<render::BaseRenderer> renderer_;
  core::ImageRgba8 picture_;
  std::optional<float> exposureEv_;  ///< of the picture
};

}  // namespace saccade::app
