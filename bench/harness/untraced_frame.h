// The frame without tracing: age, draw, read back, warp, splat and composite (Haber 2001, section 5:
// everything but the correction step), stage by stage, with a cache of the caller's own.
#pragma once

#include "core/image.h"
#include "render/base/base_renderer.h"
#include "render/splat/correction_layer.h"
#include "render/splat/sample_cache.h"

namespace saccade::bench {

/// Wall milliseconds of one frame.
struct UntracedFrame {
  double age = 0;
  double draw = 0;     ///< OpenGL until it has finished
  double read = 0;     ///< colour, ID and depth into main memory
  double measure = 0;  ///< boxes and start levels of the objects
  double warp = 0;     ///< the layer's beginFrame, warping and splatting
  double composite = 0;
  double total = 0;
  double splatted = 0;  ///< samples that the warp handed to the layer
};

/// What FrameLoop does of a frame when nothing is traced and nothing analysed. FrameLoop itself has one cache
/// that it fills by tracing; here any cache is drawn. GL thread.
class UntracedPicture {
 public:
  UntracedPicture(render::BaseRenderer& renderer, const render::AgingOptions& aging)
      : renderer_(renderer), aging_(aging) {}

  UntracedFrame draw(const core::View& view, render::SampleCache& cache);

 private:
  render::BaseRenderer& renderer_;
  render::AgingOptions aging_;
  render::CorrectionLayer layer_;
  core::ImageRgba8 display_;
};

}  // namespace saccade::bench
