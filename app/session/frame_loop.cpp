#include "app/session/frame_loop.h"

#include <algorithm>
#include <utility>

#include "core/composite.h"

namespace saccade::app {

namespace {

/// Adds the time of its scope to one stage.
class StageTimer {
 public:
  StageTimer(RunStats& stats, const char* stage) : total_(stats.stageMs[stage]) {}
  ~StageTimer() {
    total_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

constexpr std::chrono::milliseconds kStopPollInterval{20};
constexpr int kLateBatches = 32;  // some tenths of a millisecond of splatting

attention::AttentionOptions seeded(attention::AttentionOptions options, std::uint32_t seed) {
  options.seed = seed;
  return options;
}

}  // namespace

FrameLoop::FrameLoop(const Workspace& workspace, render::BaseRenderer& renderer,
                     const FrameLoopOptions& options)
    : workspace_(workspace),
      renderer_(renderer),
      options_(options),
      regions_(options.corrective.jobSize),
      tracer_(*workspace.world,
              {.seed = options.seed, .samplesPerPixel = options.corrective.samplesPerPixel}),
      cache_(static_cast<std::size_t>(options.corrective.cacheMb) << 20),
      analyzer_(seeded(options.corrective.attention, options.seed)),
      pool_(tracer_, regions_, samples_, options.threads) {
  stats_.seed = options.seed;
  stats_.threads = options.threads;
  if (options.asynchronousAnalysis) analyzer_.start(mailbox_, regions_);
}

FrameLoop::~FrameLoop() {
  mailbox_.close();
  regions_.close();
  samples_.close();
}

void FrameLoop::step(const core::Camera& camera, ImageSize size, const FrameBudget& budget,
                     const std::stop_token& stop) {
  const Clock::time_point start = Clock::now();
  pool_.check();
  analyzer_.check();
  const std::uint64_t tracedBefore = stats_.samplesTraced;
  if (cameraChanged(camera, size)) beginFrame(camera, size);
  {
    const StageTimer timer(stats_, "correct");
    correct(start, budget, stop);
  }
  const Clock::time_point tail = Clock::now();
  composite();
  feedAnalyzer();
  tailSeconds_ = 0.8 * tailSeconds_ + 0.2 * std::chrono::duration<double>(Clock::now() - tail).count();
  stats_.samplesPerFrame.push_back(stats_.samplesTraced - tracedBefore);
  finishStats(start, budget);
}

bool FrameLoop::cameraChanged(const core::Camera& camera, ImageSize size) const {
  return !frame_ || !frame_->view.camera().samePicture(camera) || frame_->view.width() != size.width ||
         frame_->view.height() != size.height;
}

// Steps 2 to 5. Steps 3 and 4 do not run while nothing moves (design fact 14).
void FrameLoop::beginFrame(const core::Camera& camera, ImageSize size) {
  const core::View view(camera, size.width, size.height, workspace_.scene.bounds);
  const CorrectiveOptions& o = options_.corrective;
  dropPending();
  {
    const StageTimer timer(stats_, "age");
    stats_.samplesDropped += cache_.age(view, {o.nMin, o.delta, o.maxAge}).deleted;
  }
  {
    const StageTimer timer(stats_, "draw");
    frame_ = renderer_.render(view, cache_.cameraAge(), o.nMin);
  }
  {
    const StageTimer timer(stats_, "warp");
    layer_.beginFrame(frame_);
    if (reuse_) {
      const render::SampleCache::WarpResult warped = cache_.warp(*frame_, layer_);
      stats_.samplesReused += warped.splatted;
      stats_.samplesDropped += warped.dropped;
    }
  }
  if (!options_.asynchronousAnalysis) analyseNow();
  regions_.beginFrame(frame_);
}

void FrameLoop::analyseNow() {
  composite();
  const StageTimer timer(stats_, "analyse");
  regions_.setPriorities(analyzer_.analyzeNow({frame_, display_}));
  displayIsShared_ = true;
}

void FrameLoop::correct(Clock::time_point start, const FrameBudget& budget, const std::stop_token& stop) {
  using Kind = FrameBudget::Kind;
  if (budget.kind == Kind::samples) return correctSamples(budget.samples, stop);
  if (options_.threads == 0) return correctInline(budget, stop);
  if (budget.kind == Kind::converge) return correctAll(stop);
  const auto time = std::chrono::duration<double>(std::max(0.0, budget.time.count() - tailSeconds_));
  correctUntil(start + std::chrono::duration_cast<Clock::duration>(time), stop);
}

// Step 6 against the wall clock. What waits in the queue is taken even when drawing used up the time
// (bounded), else the tracers' work for a frame that is too slow would never be seen.
void FrameLoop::correctUntil(Clock::time_point deadline, const std::stop_token& stop) {
  for (int late = 0; late < kLateBatches && !stop.stop_requested();) {
    const Clock::time_point now = Clock::now();
    auto batch =
        now < deadline ? samples_.popUntil(std::min(deadline, now + kStopPollInterval)) : samples_.tryPop();
    if (batch) take(*batch);
    if (now >= deadline) late = batch ? late + 1 : kLateBatches;
  }
}

// Step 6 without tracer threads. A virtual clock counts rays, so that a run repeats exactly.
void FrameLoop::correctInline(const FrameBudget& budget, const std::stop_token& stop) {
  const bool timed = budget.kind == FrameBudget::Kind::deadline;
  const auto raysAllowed = static_cast<std::uint64_t>(budget.time.count() * kVirtualRaysPerSecond);
  const std::uint64_t raysBefore = pool_.rays();
  while (!stop.stop_requested() && (!timed || pool_.rays() - raysBefore < raysAllowed) && pool_.runOne()) {
    while (auto batch = samples_.tryPop()) take(*batch);
  }
}

// Step 6 until every pixel on the mask is exact.
void FrameLoop::correctAll(const std::stop_token& stop) {
  while (!layer_.converged() && !stop.stop_requested()) {
    if (auto batch = samples_.popUntil(Clock::now() + kStopPollInterval)) take(*batch);
    pool_.check();
  }
}

// Step 6 for a number of samples: jobs are numbered in the order in which they are handed out, which does not
// depend on the number of tracers, so the batches are taken in that order and the last one is cut (design
// fact 10).
void FrameLoop::correctSamples(std::uint64_t count, const std::stop_token& stop) {
  std::uint64_t taken = takeInOrder(count);
  while (taken < count && !layer_.converged() && !stop.stop_requested()) {
    if (options_.threads == 0) pool_.runOne();
    auto batch = samples_.popUntil(Clock::now() + kStopPollInterval);
    pool_.check();
    if (!batch || batch->epoch != frame_->epoch) continue;
    pending_.emplace(batch->sequence, std::move(*batch));
    taken += takeInOrder(count - taken);
  }
}

/// Takes what stands at the head of the order; the rest of a cut batch waits for the next frame of this
/// camera.
std::uint64_t FrameLoop::takeInOrder(std::uint64_t atMost) {
  std::uint64_t taken = 0;
  for (auto it = pending_.find(nextSequence_); it != pending_.end() && taken < atMost;
       it = pending_.find(nextSequence_)) {
    std::vector<core::Sample>& samples = it->second.samples;
    const auto cut = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(atMost - taken, samples.size()));
    core::SampleBatch head{it->second.epoch, it->second.sequence, {samples.begin(), samples.begin() + cut}};
    take(head);
    taken += static_cast<std::uint64_t>(cut);
    samples.erase(samples.begin(), samples.begin() + cut);
    if (!samples.empty()) break;
    pending_.erase(it);
    ++nextSequence_;
  }
  return taken;
}

void FrameLoop::dropPending() {
  for (const auto& [sequence, batch] : pending_) stats_.samplesDropped += batch.samples.size();
  pending_.clear();
  nextSequence_ = 0;
}

void FrameLoop::take(core::SampleBatch& batch) {
  if (onBatch) onBatch(batch);
  if (batch.epoch == frame_->epoch) {
    for (const core::Sample& sample : batch.samples) {
      layer_.splat(sample);
      ++stats_.levels[sample.level];
      stats_.fromDepth += sample.fromDepth ? 1 : 0;
    }
    stats_.samplesTraced += batch.samples.size();
  }
  // Samples for an older frame are never exact; they wait in the cache for the next camera change (design
  // fact 6).
  cache_.add(batch, batch.epoch);
}

// Step 7.
void FrameLoop::composite() {
  const StageTimer timer(stats_, "composite");
  if (!display_ || displayIsShared_) display_ = std::make_shared<core::ImageRgba8>();
  displayIsShared_ = false;
  const auto corrections = showCorrections_ ? layer_.pixels() : std::span<const core::Vec4>{};
  core::compositeDisplay(frame_->view.width(), frame_->view.height(), frame_->baseAndId, corrections,
                         options_.exposureEv, *display_);
}

// Step 8. The analyzer keeps the picture, so the next composite goes into a new one.
void FrameLoop::feedAnalyzer() {
  if (!options_.asynchronousAnalysis || !mailbox_.wanted()) return;
  mailbox_.put({frame_, display_});
  displayIsShared_ = true;
}

core::ImageRgb FrameLoop::linear() {
  return core::compositeLinear(frame_->view.width(), frame_->view.height(), frame_->baseAndId,
                               layer_.pixels());
}

void FrameLoop::finishStats(Clock::time_point start, const FrameBudget& budget) {
  const std::chrono::duration<double> taken = Clock::now() - start;
  stats_.frameMs.push_back(1000 * taken.count());
  if (budget.missedAfter(taken)) ++stats_.missedDeadlines;
  stats_.nonDiffusePixels = frame_->nonDiffusePixels;
  stats_.converged = layer_.converged();
  stats_.rays = pool_.rays();
  stats_.tracingSeconds = stats_.stageMs["correct"] / 1000;
}

}  // namespace saccade::app
