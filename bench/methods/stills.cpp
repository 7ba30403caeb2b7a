#include "bench/methods/stills.h"

#include <array>
#include <string>

#include "bench/harness/machine.h"
#include "bench/harness/trials.h"
#include "core/composite.h"
#include "core/error.h"
#include "core/image_io.h"
#include "raytrace/path_tracer.h"
#include "raytrace/reference.h"

namespace saccade::bench {
namespace {

constexpr std::array<int, 8> kBudgetsMs = {8, 16, 33, 66, 125, 250, 500, 1000};
constexpr std::array<int, 4> kSubSamples = {1, 4, 16, 64};
constexpr int kNMin = app::CorrectiveOptions{}.nMin;

void checkStop(const StillTask& task) {
  if (task.stop.stop_requested()) throw core::Error("stopped on request");
}

core::FramePtr drawBase(Stage& stage, const StillTask& task) {
  return stage.gl->renderer->render(stage.view(task.camera, task.size), 1, kNMin);
}

/// What a viewer would show; its cost belongs to a method's seconds.
void show(const StillTask& task, const core::FrameSnapshot& frame, std::span<const core::Vec4> corrections) {
  core::ImageRgba8 display;
  core::compositeDisplay(task.size.width, task.size.height, frame.baseAndId, corrections, 0, display);
}

/// One frame of a new frame loop. True where it converged.
bool drawCorrective(Stage& stage, const StillTask& task, const app::CorrectiveOptions& options,
                    const app::FrameBudget& budget, Point& point) {
  const Pinned main(mainCores());
  app::FrameLoopOptions loopOptions;
  loopOptions.corrective = options;
  loopOptions.threads = stage.tracers;
  loopOptions.seed = stage.seed;
  const auto loop = pinnedLoop(stage, loopOptions);
  point.seconds = timed([&] { loop->step(task.camera, task.size, budget, task.stop); });
  checkStop(task);
  point.linear = loop->linear();
  point.samples = loop->stats().samplesTraced;
  point.rays = loop->stats().rays;
  return loop->converged();
}

}  // namespace

void stillBase(Stage& stage, const StillTask& task, const TakePoint& take) {
  Point point;
  point.setting = "drawn";
  core::FramePtr frame;
  point.seconds = timed([&] {
    frame = drawBase(stage, task);
    show(task, *frame, {});
  });
  point.linear = core::compositeLinear(task.size.width, task.size.height, frame->baseAndId, {});
  take(std::move(point));
}

void stillCorrective(Stage& stage, const StillTask& task, const TakePoint& take,
                     const attention::AttentionOptions& attention, bool toTheEnd) {
  app::CorrectiveOptions options;
  options.attention = attention;
  for (const int budget : kBudgetsMs) {
    Point point;
    point.setting = std::to_string(budget) + " ms";
    point.budgetMs = budget;
    const bool converged = drawCorrective(
        stage, task, options, app::FrameBudget::untilDeadline(std::chrono::milliseconds(budget)), point);
    take(std::move(point));
    if (converged) break;
  }
  if (!toTheEnd) return;
  for (const int subSamples : kSubSamples) {
    Point point;
    point.subSamples = options.samplesPerPixel = subSamples;
    point.setting = "converged, " + std::to_string(subSamples) + " spp";
    drawCorrective(stage, task, options, app::FrameBudget::untilConverged(), point);
    const double seconds = point.seconds;
    take(std::move(point));
    if (seconds > task.longestSeconds) return;
  }
}

Point stillAfterSamples(Stage& stage, const StillTask& task, const attention::AttentionOptions& attention,
                        std::uint64_t samples) {
  app::CorrectiveOptions options;
  options.attention = attention;
  Point point;
  point.setting = std::to_string(samples) + " samples";
  drawCorrective(stage, task, options, app::FrameBudget::firstSamples(samples), point);
  return point;
}

void stillRaytrace(Stage& stage, const StillTask& task, const TakePoint& take) {
  for (const int subSamples : kSubSamples) {
    const raytrace::CorrectiveTracer tracer(*stage.workspace->world,
                                            {.seed = stage.seed, .samplesPerPixel = subSamples});
    Point point;
    point.subSamples = subSamples;
    point.setting = std::to_string(subSamples) + " spp";
    core::FramePtr frame;
    raytrace::TraceAllResult all;
    point.seconds = timed([&] {
      frame = drawBase(stage, task);
      all = raytrace::traceAll(tracer, *frame, stage.cores, {{}, task.stop});
      show(task, *frame, all.corrections);
    });
    point.linear =
        core::compositeLinear(task.size.width, task.size.height, frame->baseAndId, all.corrections);
    point.samples = all.traced;
    point.rays = all.counters.rays;
    const double seconds = point.seconds;
    take(std::move(point));
    if (seconds > task.longestSeconds) return;
  }
}

void stillPath(Stage& stage, const StillTask& task, const TakePoint& take) {
  const core::View view = stage.view(task.camera, task.size);
  for (int samples = 1;; samples *= 2) {
    raytrace::PathOptions options;
    options.samplesPerPixel = samples;
    options.seed = stage.seed;
    options.threads = stage.cores;
    Point point;
    point.subSamples = samples;
    point.setting = std::to_string(samples) + " spp";
    raytrace::PathResult result;
    point.seconds = timed([&] {
      result = raytrace::tracePaths(*stage.workspace->world, view, options, {{}, task.stop});
      core::toDisplay(result.radiance, 0);
    });
    point.linear = std::move(result.radiance);
    point.samples = static_cast<std::uint64_t>(samples) * point.linear.pixels().size();
    point.rays = result.counters.rays;
    const double seconds = point.seconds;
    take(std::move(point));
    if (seconds > task.longestSeconds) return;
  }
}

}  // namespace saccade::bench
