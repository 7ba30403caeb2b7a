// The base layer of a scene that is still being opened: uploaded a little every frame, and shown where no
// other scene is, while its ray-tracing world is built.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "app/viewer/scene_opener.h"
#include "core/camera.h"
#include "core/image.h"
#include "render/base/base_renderer.h"

namespace saccade::app {

/// GL thread only, the destructor included. The context must outlive it.
class BaseView {
 public:
  /// Nothing is uploaded yet; the workspace needs no world.
  BaseView(const SceneOpener::Reading& reading, render::GlContext& context);

  const std::shared_ptr<const Workspace>& workspace() const { return reading_.workspace; }
  /// Uploads until the time is up (render::BaseUpload). Returns whether no more is left to do: all is there,
  /// or error() says why it never will be.
  bool upload(std::chrono::steady_clock::time_point until);
  const std::string& error() const { return error_; }
  /// All is there.
  bool ready() const { return renderer_ != nullptr; }
  bool done() const { return ready() || !error_.empty(); }

  /// Seen through the visit's first camera; drawn anew where size or exposure changed. Empty until all is
  /// there. Throws core::Error.
  const core::ImageRgba8& picture(ImageSize size, float exposureEv);
  /// What was uploaded. Nothing else may be called afterwards.
  std::unique_ptr<render::BaseRenderer> takeRenderer() { return std::move(renderer_); }

 private:
  void begin();

  const SceneOpener::Reading reading_;
  render::GlContext& context_;
  std::string error_;
  core::Camera camera_;
  std::unique_ptr<render::BaseUpload> upload_;      ///< null before the first call and once it is done
  std::unique_ptr<render::BaseRenderer> renderer_;  ///< null until then
  core::ImageRgba8 picture_;
  std::optional<float> exposureEv_;  ///< of the picture
};

}  // namespace saccade::app
