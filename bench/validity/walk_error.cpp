#include "bench/validity/walk_error.h"

#include <cmath>

#include "core/composite.h"
#include "core/image_io.h"
#include "core/metrics/comparison.h"
#include "raytrace/reference.h"

namespace saccade::bench {
namespace {

constexpr int kFrames = 60, kFirstTruth = 35, kTruthEach = 4;

double displayed(float linear) { return core::encodeSrgb(std::clamp(linear, 0.0f, 1.0f)); }

}  // namespace

double KindError::rmse() const { return pixels > 0 ? std::sqrt(squared / (3 * pixels)) : 0; }
double KindError::meanFlip() const { return pixels > 0 ? flip / pixels : 0; }

ComparedWalk::ComparedWalk(const Stage& stage, const app::CameraPath& path) : stage_(stage) {
  const double begin = std::max(0.0, 0.5 * (path.lengthSeconds() - kFrames * kValidityFrameSeconds));
  const raytrace::CorrectiveTracer tracer(*stage.workspace->world, {.seed = stage.seed});
  for (int i = 0; i < kFrames; ++i) {
    cameras_.push_back(path.at(begin + i * kValidityFrameSeconds));
    if (i < kFirstTruth || (i - kFirstTruth) % kTruthEach != 0) continue;
    const core::FramePtr frame = stage.gl->renderer->render(stage.view(cameras_.back(), kValiditySize), 1,
                                                            app::CorrectiveOptions{}.nMin);
    const raytrace::TraceAllResult all = raytrace::traceAll(tracer, *frame, 0, {});
    truths_.push_back(
        {i,
         core::compositeLinear(kValiditySize.width, kValiditySize.height, frame->baseAndId, all.corrections),
         frame->ids});
  }
}

void ComparedWalk::walk(app::AgingTest test, float delta, KindErrors& errors) const {
  app::FrameLoopOptions options{.threads = 0, .seed = stage_.seed};
  options.corrective.aging = test;
  options.corrective.delta = delta;
  app::FrameLoop loop(*stage_.workspace, *stage_.gl->renderer, options);
  auto truth = truths_.begin();
  for (int i = 0; i < kFrames && truth != truths_.end(); ++i) {
    loop.step(cameras_[static_cast<std::size_t>(i)], kValiditySize,
              app::FrameBudget::firstSamples(kValiditySamples));
    if (truth->frame != i) continue;
    const core::ImageRgb shown = loop.linear();
    const core::Comparison comparison = core::compareLinear(truth->linear, shown);
    for (std::size_t p = 0; p < truth->ids.size(); ++p) {
      if (truth->ids[p] == 0) continue;
      const auto id = static_cast<std::uint32_t>(truth->ids[p]);
      KindError& e = errors[static_cast<std::size_t>(kindOf(*stage_.workspace->world, id))];
      for (int c = 0; c < 3; ++c)
        e.squared += std::pow(displayed(shown.pixels()[p][c]) - displayed(truth->linear.pixels()[p][c]), 2.0);
      e.flip += comparison.flipMap.pixels()[p];
      ++e.pixels;
    }
    ++truth;
  }
}

}  // namespace saccade::bench
