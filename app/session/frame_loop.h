// The frame loop of Haber 2001, section 4.1: draw, warp, correct until the deadline, composite, feed the
// analyzer.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/cli/options.h"
#include "app/session/corrected_picture.h"
#include "app/session/session_sink.h"
#include "app/session/stats.h"
#include "app/session/workspace.h"
#include "attention/analyzer.h"
#include "core/corrective/messages.h"
#include "core/corrective/queues.h"
#include "core/corrective/sample_gains.h"
#include "core/image.h"
#include "raytrace/corrective_tracer.h"
#include "raytrace/tracer_pool.h"
#include "render/base/base_renderer.h"

namespace saccade::app {

/// What ends a frame's correction step (step 6). Exactly one of the three counts.
struct FrameBudget {
  enum class Kind { deadline, samples, converge } kind = Kind::deadline;
  /// deadline: time from the start of the frame. With 0 threads a virtual clock counts instead:
  /// kVirtualRaysPerSecond.
  std::chrono::duration<double> time{1.0 / 25};
  /// samples: the first so many samples of the inline schedule, the same on any number of threads.
  std::uint64_t samples = 0;

  static FrameBudget untilDeadline(std::chrono::duration<double> t) { return {Kind::deadline, t, 0}; }
  static FrameBudget firstSamples(std::uint64_t n) { return {Kind::samples, {}, n}; }
  static FrameBudget untilConverged() { return {Kind::converge, {}, 0}; }

  /// Whether a frame that took so long missed its deadline: by more than timers and scheduler are worth.
  bool missedAfter(std::chrono::duration<double> taken) const {
    constexpr std::chrono::duration<double> kTimerSlack{1e-3};
    return kind == Kind::deadline && taken > time + kTimerSlack;
  }
};

struct FrameLoopOptions {
  CorrectiveOptions corrective;
  int threads = 1;  ///< tracers; 0 = every stage inline
  std::uint32_t seed = 1;
  float exposureEv = 0;
  /// An analyzer thread follows the walk; else each new frame is analysed before it is corrected (still
  /// pictures, inline runs), which makes the schedule a function of the frame alone.
  bool asynchronousAnalysis = false;
  /// Another number than a walk's cannot be replayed. For stills, which have one frame only.
  std::size_t probesAFrame = CorrectedPicture::kProbesAFrame;
};

/// Main thread only: it owns the GL context, the camera, the correction layer and the sample cache.
class FrameLoop {
 public:
  /// Rays that the virtual clock of inline runs lets pass in a second.
  static constexpr double kVirtualRaysPerSecond = 2e6;

  FrameLoop(const Workspace& workspace, render::BaseRenderer& renderer, const FrameLoopOptions& options);
  ~FrameLoop();
  FrameLoop(const FrameLoop&) = delete;
  FrameLoop& operator=(const FrameLoop&) = delete;

  /// All eight steps for one frame. Throws what a worker threw. `stop` ends step 6 early.
  void step(const core::Camera& camera, ImageSize size, const FrameBudget& budget,
            const std::stop_token& stop = {});

  /// Before the first step: see CorrectedPicture::resume.
  void resume(const VisitEnd& end) { picture_.resume(end); }
  /// Of the last step; nothing before the first.
  std::optional<VisitEnd> visitEnd() const {
    return picture_.frame() ? std::optional(picture_.visitEnd()) : std::nullopt;
  }

  const core::ImageRgba8& display() const { return picture_.display(); }  ///< of the last step
  core::ImageRgb linear() { return picture_.linear(); }                   ///< what the last step showed
  const core::FrameSnapshot& frame() const { return *picture_.frame(); }
  /// What the picture adds to the base: width * height; valid until the next step.
  std::span<const core::Vec4> corrections() { return picture_.layer().pixels(); }
  /// Whether the next step with this camera goes on with the picture of the last one.
  bool rests(const core::Camera& camera, ImageSize size) const { return picture_.shows(camera, size); }
  const raytrace::CorrectiveTracer& tracer() const { return tracer_; }
  const render::CorrectionLayer& layer() const { return picture_.layer(); }
  const render::SampleCache& cache() const { return picture_.cache(); }
  render::SampleCache& cache() { return picture_.cache(); }  ///< to be filled before the first step
  const attention::Analyzer& analyzer() const { return analyzer_; }
  const RunStats& stats() const { return stats_; }
  bool converged() const { return layer().converged(); }

  /// Weight between saliency (0) and task (1), from the window's slider.
  void setAttention(float weight) {
    analyzer_.setAttention(weight);
    options_.corrective.attention.attention = weight;
  }
  /// A person points at an object: attention::Analyzer::attend. At rest too the next step corrects it first.
  /// A recording holds the samples as they arrived, so a replay needs to know of no click.
  void attend(std::uint32_t id) {
    analyzer_.attend(id);
    newlyAttended_ = true;
  }
  /// What is corrected next, by id: RegionQueue::ranks. Importance is analyzer().latest()'s.
  std::vector<std::uint32_t> ranks() const { return regions_.ranks(); }
  const PictureSettings& settings() const { return picture_.settings(); }
  void setExposure(float ev) { picture_.settings().exposureEv = ev; }
  void setDelta(float delta) { picture_.settings().delta = delta; }
  /// Off: the base layer alone is shown; samples go on being traced.
  void showCorrections(bool on) { picture_.settings().corrections = on; }
  /// What shows where nothing is corrected yet: light probes or the base layer alone.
  void approximate(bool on) { picture_.settings().approximation = on; }
  /// Off: every frame starts without the samples of earlier ones.
  void reuseSamples(bool on) { picture_.settings().reuse = on; }
  /// The next step draws again although the camera did not move.
  void invalidate() { picture_.invalidate(); }

  /// From the first step on, `sink` hears of everything that pictures depend on; it must outlive the loop.
  void recordTo(SessionSink& sink) { sink_ = &sink; }
  bool recording() const { return sink_ != nullptr; }

  /// Called for each batch as it arrives, before it is splatted: tests perturb, shuffle and count through it.
  std::function<void(core::SampleBatch&)> onBatch;

 private:
  using Clock = std::chrono::steady_clock;

  void beginFrame(const core::Camera& camera, ImageSize size);
  void analyseNow();
  void correct(Clock::time_point start, const FrameBudget& budget, const std::stop_token& stop);
  void correctUntil(Clock::time_point deadline, const std::stop_token& stop);
  void correctInline(const FrameBudget& budget, const std::stop_token& stop);
  void correctSamples(std::uint64_t count, const std::stop_token& stop);
  void correctAll(const std::stop_token& stop);
  std::uint64_t takeInOrder(std::uint64_t atMost);
  void takePending();
  void noteGains(const core::SampleBatch& batch);
  void dropPending();
  void take(core::SampleBatch&& batch);
  void feedAnalyzer();
  void record(bool newView);
  void finishStats(Clock::time_point start, const FrameBudget& budget);

  FrameLoopOptions options_;
  SessionSink* sink_ = nullptr;

  core::RegionQueue regions_;
  core::SampleGains gains_;
  core::SampleQueue samples_;
  core::SnapshotMailbox mailbox_;
  raytrace::CorrectiveTracer tracer_;
  RunStats stats_;
  CorrectedPicture picture_;
  bool newlyAttended_ = false;  ///< since the last step
  double tailSeconds_ = 0;      ///< running mean of steps 7 and 8, kept free of the deadline
  std::map<std::uint64_t, core::SampleBatch>
      pending_;                     ///< sample budget: batches of this frame not yet taken
  std::uint64_t nextSequence_ = 0;  ///< sample budget: after what was taken of this frame
  // Declared last: their threads use the channels above and must end first.
  attention::Analyzer analyzer_;
  raytrace::TracerPool pool_;
};

}  // namespace saccade::app
