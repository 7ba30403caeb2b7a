#include "bench/walkorder/walk.h"

#include <algorithm>
#include <cmath>

#include "core/composite.h"
#include "core/image_io.h"
#include "core/metrics/flip.h"
#include "raytrace/reference.h"

namespace saccade::bench {
namespace {

constexpr double kFrameSeconds = 1.0 / 25;
constexpr int kFrames = 36;
// The first comes when the cache holds what it will hold, more or less.
constexpr int kFirstKeyView = 15, kKeyViewEach = 5;

double displayed(float linear) { return core::encodeSrgb(std::clamp(linear, 0.0f, 1.0f)); }

/// Mean over the channels.
core::ImageGray squaredErrors(const core::ImageRgb& truth, const core::ImageRgb& shown) {
  core::ImageGray map(truth.width(), truth.height());
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    double sum = 0;
    for (int c = 0; c < 3; ++c)
      sum += std::pow(displayed(shown.pixels()[i][c]) - displayed(truth.pixels()[i][c]), 2.0);
    map.pixels()[i] = static_cast<float>(sum / 3);
  }
  return map;
}

}  // namespace

OrderWalk::OrderWalk(const Stage& stage, const app::CameraPath& path, double place, app::ImageSize size,
                     std::uint32_t seed)
    : stage_(stage), size_(size), seed_(seed) {
  const double begin = std::max(0.0, path.lengthSeconds() * place - 0.5 * kFrames * kFrameSeconds);
  const raytrace::CorrectiveTracer tracer(*stage.workspace->world, {.seed = seed});
  for (int i = 0; i < kFrames; ++i) {
    cameras_.push_back(path.at(begin + i * kFrameSeconds));
    if (i < kFirstKeyView || (i - kFirstKeyView) % kKeyViewEach != 0) continue;
    const core::FramePtr frame =
        stage.gl->renderer->render(stage.view(cameras_.back(), size), 1, app::CorrectiveOptions{}.nMin);
    const raytrace::TraceAllResult all = raytrace::traceAll(tracer, *frame, stage.cores, {});
    keyViews_.push_back(
        {i, Grader(core::compositeLinear(size.width, size.height, frame->baseAndId, all.corrections))});
  }
}

WalkError OrderWalk::walk(const app::CorrectiveOptions& options, std::uint64_t samplesPerFrame) const {
  app::FrameLoop loop(*stage_.workspace, *stage_.gl->renderer,
                      {.corrective = options, .threads = 0, .seed = seed_});
  WalkError error;
  auto key = keyViews_.begin();
  for (int i = 0; i <= keyViews_.back().frame; ++i) {
    loop.step(cameras_[static_cast<std::size_t>(i)], size_, app::FrameBudget::firstSamples(samplesPerFrame));
    if (key->frame != i) continue;
    const core::ImageRgb shown = loop.linear();
    const Grade grade = key->truth.grade(shown);
    const core::ImageGray squared = squaredErrors(key->truth.reference(), shown);
    error.rmse += core::meanOf(squared);
    error.rmseSalient += core::weightedMeanOf(squared, key->truth.saliency());
    error.flip += grade.errors.flip;
    error.flipSalient += grade.flipSalient;
    ++key;
  }
  const auto n = static_cast<double>(keyViews_.size());
  return {std::sqrt(error.rmse / n), std::sqrt(error.rmseSalient / n), error.flip / n, error.flipSalient / n};
}

}  // namespace saccade::bench
