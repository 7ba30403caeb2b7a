// What a walk shows, given its samples: steps 2 to 5 and 7 of Haber 2001, section 4.1. Nothing else decides
// what a pixel shows and no ray is traced here, so the same calls give the same pictures: a replay makes
// those that a walk recorded.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/cli/options.h"
#include "app/session/stats.h"
#include "app/session/visit_end.h"
#include "core/corrective/messages.h"
#include "core/image.h"
#include "core/scene/scene.h"
#include "render/base/base_renderer.h"
#include "render/probe/approximation.h"
#include "render/splat/correction_layer.h"
#include "render/splat/sample_cache.h"

namespace saccade::app {

/// All settings that a picture depends on. Those the cache is made with hold for a whole walk, the others may
/// change from frame to frame.
struct PictureSettings {
  AgingTest aging = AgingTest::haber;
  float delta = 0.1f;
  int nMin = 10;
  int maxAge = 30;
  int cacheMb = 64;  ///< of the whole walk
  float exposureEv = 0;
  bool corrections = true;  ///< off: the base layer alone is shown; samples go on being taken
  bool reuse = true;        ///< off: every frame starts without the samples of earlier ones
  /// Where no splat covers an object, what light probes tell is shown; off: the base layer alone.
  bool approximation = false;

  bool operator==(const PictureSettings&) const = default;
};

/// Main thread only. Counts and times go to `stats`.
class CorrectedPicture {
 public:
  /// A walk draws few light probes a frame, so that its first ones do not take long; a replay must draw as
  /// many.
  static constexpr std::size_t kProbesAFrame = 2;

  CorrectedPicture(const core::Scene& scene, render::BaseRenderer& renderer, const PictureSettings& settings,
                   RunStats& stats, std::size_t probesAFrame = kProbesAFrame);

  PictureSettings& settings() { return settings_; }
  const PictureSettings& settings() const { return settings_; }

  /// Whether a frame with this camera goes on with the picture of the last one.
  bool shows(const core::Camera& camera, ImageSize size) const;
  /// The next camera is a new one although it may be the same.
  void invalidate() { frame_ = nullptr; }
  /// Before the first begin, with cache() filled by an earlier visit: where that begin's frame turns out to
  /// be the very one that the visit ended with, its samples are exact and the picture goes on from there. Any
  /// other frame takes them for what they are, samples of an older camera.
  void resume(const VisitEnd& end) { resumed_ = end; }
  /// Of the frame there is.
  VisitEnd visitEnd() const;

  /// Steps 2 to 5, for a new camera: aging, base layer, read-back, warp.
  void begin(const core::Camera& camera, ImageSize size);
  /// Splats what was traced for this frame, and caches it. Samples for an older frame are never exact; they
  /// wait in the cache for the next camera change (design fact 6). No batch may be of a later epoch than the
  /// frame's.
  void take(const core::SampleBatch& batch);
  /// Once a frame, before its last composite: light probes for what no splat covers, a few at a time. Nothing
  /// else draws any, for a replay has the same frames and no more.
  void drawProbes();
  /// Step 7.
  void composite();

  const core::FramePtr& frame() const { return frame_; }  ///< null before the first begin
  /// The frame as begin() left it, with only those pixels on its mask that were not exact then.
  const core::FramePtr& toTrace() const { return toTrace_; }
  /// What the picture shows before anything is traced, to be asked after begin(): null for no sample at all.
  core::KnownLevels known();
  const core::ImageRgba8& display() const { return *display_; }  ///< of the last composite
  /// The same for another thread: the next composite goes into another image.
  std::shared_ptr<const core::ImageRgba8> shareDisplay();
  /// Base + correction as they are now, with the approximation where it is on and nothing is corrected yet;
  /// the base alone where corrections are off.
  core::ImageRgb linear();
  render::CorrectionLayer& layer() { return layer_; }
  const render::CorrectionLayer& layer() const { return layer_; }
  render::SampleCache& cache() { return cache_; }
  const render::SampleCache& cache() const { return cache_; }

 private:
  void age(const core::View& view);
  void draw(const core::View& view);
  bool drawResumed(const core::View& view);
  void warp();
  void showExact();
  std::span<const core::Vec4> corrections();
  void listBare();
  void approximate();

  const core::Scene& scene_;
  render::BaseRenderer& renderer_;
  PictureSettings settings_;
  RunStats& stats_;
  const std::size_t probesAFrame_;
  render::CorrectionLayer layer_;
  render::SampleCache cache_;
  core::FramePtr frame_, toTrace_;
  bool reused_ = false;  ///< begin() has splatted samples of older cameras
  std::optional<VisitEnd> resumed_;
  std::optional<render::Approximation> approximation_;  ///< once it was on
  std::vector<core::Pixel> bare_;         ///< without a splat, of the last composite; empty where off
  std::vector<core::Vec3> approximated_;  ///< of bare_
  std::shared_ptr<core::ImageRgba8> display_;
  bool displayIsShared_ = false;  ///< another thread may be reading display_
};

}  // namespace saccade::app
