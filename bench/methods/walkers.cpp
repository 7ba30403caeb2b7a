#include "bench/methods/walkers.h"

#include <utility>

#include "bench/harness/machine.h"
#include "bench/harness/trials.h"
#include "core/composite.h"
#include "core/image_io.h"
#include "raytrace/corrective_tracer.h"
#include "raytrace/path_tracer.h"
#include "raytrace/reference.h"

namespace saccade::bench {
namespace {

/// Frames that know nothing of those before them.
class FreshWalker : public Walker {
 public:
  FreshWalker(Stage& stage, app::ImageSize size) : stage_(stage), size_(size) {
    stats_.seed = stage.seed;
    stats_.threads = stage.cores;
  }

  void frame(const core::Camera& camera, std::chrono::duration<double> budget) final {
    const Clock::time_point start = Clock::now();
    const std::uint64_t tracedBefore = stats_.samplesTraced;
    draw(stage_.view(camera, size_));
    const std::chrono::duration<double> taken = Clock::now() - start;
    stats_.frameMs.push_back(1000 * taken.count());
    stats_.samplesPerFrame.push_back(stats_.samplesTraced - tracedBefore);
    if (app::FrameBudget::untilDeadline(budget).missedAfter(taken)) ++stats_.missedDeadlines;
  }

  const core::ImageRgba8& display() const final { return display_; }
  const app::RunStats& stats() const final { return stats_; }

 protected:
  /// Makes display_ and, where rays are traced, counts them in stats_.
  virtual void draw(const core::View& view) = 0;

  Stage& stage_;
  core::ImageRgba8 display_;
  app::RunStats stats_;

 private:
  app::ImageSize size_;
};

/// The base layer, and what others add to it.
class BaseWalker : public FreshWalker {
 public:
  using FreshWalker::FreshWalker;
  core::ImageRgb linear() final {
    return core::compositeLinear(frame_->view.width(), frame_->view.height(), frame_->baseAndId,
                                 corrections_);
  }

 protected:
  void draw(const core::View& view) override {
    frame_ = stage_.gl->renderer->render(view, stats_.frameMs.size() + 1, app::CorrectiveOptions{}.nMin);
    stats_.nonDiffusePixels = frame_->nonDiffusePixels;
    correct();
    core::compositeDisplay(view.width(), view.height(), frame_->baseAndId, corrections_, 0, display_);
  }
  virtual void correct() {}

  core::FramePtr frame_;
  std::vector<core::Vec4> corrections_;  ///< empty = none
};

class RaytraceWalker : public BaseWalker {
 public:
  RaytraceWalker(Stage& stage, app::ImageSize size)
      : BaseWalker(stage, size), tracer_(*stage.workspace->world, {.seed = stage.seed}) {}

 private:
  void correct() final {
    const Pinned everyCore(workerCores(stage_.cores));
    raytrace::TraceAllResult all;
    stats_.tracingSeconds += timed([&] { all = raytrace::traceAll(tracer_, *frame_, stage_.cores, {}); });
    stats_.samplesTraced += all.traced;
    stats_.rays += all.counters.rays;
    corrections_ = std::move(all.corrections);
  }

  raytrace::CorrectiveTracer tracer_;
};

class PathWalker : public FreshWalker {
 public:
  using FreshWalker::FreshWalker;
  core::ImageRgb linear() final { return radiance_; }

 private:
  void draw(const core::View& view) final {
    const Pinned everyCore(workerCores(stage_.cores));
    const raytrace::PathOptions options{.samplesPerPixel = 1, .seed = stage_.seed, .threads = stage_.cores};
    raytrace::PathResult result;
    stats_.tracingSeconds +=
        timed([&] { result = raytrace::tracePaths(*stage_.workspace->world, view, options, {}); });
    stats_.samplesTraced += result.radiance.pixels().size();
    stats_.rays += result.counters.rays;
    radiance_ = std::move(result.radiance);
    display_ = core::toDisplay(radiance_, 0);
  }

  core::ImageRgb radiance_;
};

class CorrectiveWalker : public Walker {
 public:
  CorrectiveWalker(Stage& stage, app::ImageSize size, const attention::AttentionOptions& attention,
                   bool reuse)
      : size_(size) {
    app::FrameLoopOptions options;
    options.corrective.attention = attention;
    options.threads = stage.tracers;
    options.seed = stage.seed;
    options.asynchronousAnalysis = stage.tracers > 0;
    loop_ = pinnedLoop(stage, options);
    loop_->reuseSamples(reuse);
  }

  void frame(const core::Camera& camera, std::chrono::duration<double> budget) final {
    loop_->step(camera, size_, app::FrameBudget::untilDeadline(budget));
  }
  const core::ImageRgba8& display() const final { return loop_->display(); }
  core::ImageRgb linear() final { return loop_->linear(); }
  const app::RunStats& stats() const final { return loop_->stats(); }

 private:
  app::ImageSize size_;
  std::unique_ptr<app::FrameLoop> loop_;
};

}  // namespace

std::unique_ptr<Walker> walkBase(Stage& stage, app::ImageSize size) {
  return std::make_unique<BaseWalker>(stage, size);
}

std::unique_ptr<Walker> walkCorrective(Stage& stage, app::ImageSize size,
                                       const attention::AttentionOptions& attention, bool reuse) {
  return std::make_unique<CorrectiveWalker>(stage, size, attention, reuse);
}

std::unique_ptr<Walker> walkRaytrace(Stage& stage, app::ImageSize size) {
  return std::make_unique<RaytraceWalker>(stage, size);
}

std::unique_ptr<Walker> walkPath(Stage& stage, app::ImageSize size) {
  return std::make_unique<PathWalker>(stage, size);
}

}  // namespace saccade::bench
