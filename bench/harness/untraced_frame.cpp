#include "bench/harness/untraced_frame.h"

#include <chrono>
#include <utility>

#include "core/composite.h"

namespace saccade::bench {
namespace {

class Stopwatch {
 public:
  double lapMs() {
    const auto from = std::exchange(last_, std::chrono::steady_clock::now());
    return std::chrono::duration<double, std::milli>(last_ - from).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

UntracedFrame UntracedPicture::draw(const core::View& view, render::SampleCache& cache) {
  UntracedFrame ms;
  Stopwatch whole, stage;
  cache.age(view, aging_);
  ms.age = stage.lapMs();
  const core::FramePtr frame = renderer_.render(view, cache.cameraAge(), aging_.nMin);
  const render::DrawStats& draw = renderer_.lastDraw();
  ms.draw = 1000 * draw.drawSeconds;
  ms.read = 1000 * draw.readSeconds;
  ms.measure = 1000 * draw.measureSeconds;
  stage.lapMs();
  layer_.beginFrame(frame);
  ms.splatted = static_cast<double>(cache.warp(*frame, layer_).splatted);
  ms.warp = stage.lapMs();
  core::compositeDisplay(view.width(), view.height(), frame->baseAndId, layer_.pixels(), 0, display_);
  ms.composite = stage.lapMs();
  ms.total = whole.lapMs();
  return ms;
}

}  // namespace saccade::bench
