#include "app/session/frame_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saccade::app {

namespace {

constexpr std::chrono::milliseconds kStopPollInterval{20};
// Enough to cache what a tracer did in the time of a frame.
constexpr std::chrono::milliseconds kLateTime{2};

attention::AttentionOptions seeded(attention::AttentionOptions options, std::uint32_t seed) {
  options.seed = seed;
  return options;
}

PictureSettings settingsOf(const FrameLoopOptions& o) {
  return {.aging = o.corrective.aging,
          .delta = o.corrective.delta,
          .nMin = o.corrective.nMin,
          .maxAge = o.corrective.maxAge,
          .cacheMb = o.corrective.cacheMb,
          .exposureEv = o.exposureEv,
          .approximation = o.corrective.approximation};
}

}  // namespace

FrameLoop::FrameLoop(const Workspace& workspace, render::BaseRenderer& renderer,
                     const FrameLoopOptions& options)
    : options_(options),
      regions_(options.corrective.jobSize, options.corrective.inhibition),
      tracer_(*workspace.world,
              {.seed = options.seed, .samplesPerPixel = options.corrective.samplesPerPixel}),
      picture_(workspace.scene, renderer, settingsOf(options), stats_, options.probesAFrame),
      analyzer_(seeded(options.corrective.attention, options.seed)),
      pool_(tracer_, regions_, samples_, options.threads, options.corrective.aging == AgingTest::change) {
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
  const bool newView = !picture_.shows(camera, size);
  if (newView) {
    beginFrame(camera, size);
  } else if (newlyAttended_ && !options_.asynchronousAnalysis) {
    analyseNow();  // regions keep their progress; an analyzer thread is fed by every frame
  }
  newlyAttended_ = false;
  {
    const StageTimer timer(stats_, "correct");
    correct(start, budget, stop);
  }
  const Clock::time_point tail = Clock::now();
  const double probesBefore = stats_.stageMs["probes"];
  picture_.drawProbes();
  picture_.composite();
  feedAnalyzer();
  record(newView);
  // A probe is drawn once: no reason to leave the next frames less time.
  const double once = (stats_.stageMs["probes"] - probesBefore) / 1000;
  tailSeconds_ =
      0.8 * tailSeconds_ + 0.2 * (std::chrono::duration<double>(Clock::now() - tail).count() - once);
  stats_.samplesPerFrame.push_back(stats_.samplesTraced - tracedBefore);
  finishStats(start, budget);
}

// Steps 2 to 5. Steps 3 and 4 do not run while nothing moves (design fact 14).
void FrameLoop::beginFrame(const core::Camera& camera, ImageSize size) {
  dropPending();
  picture_.begin(camera, size);
  if (!options_.asynchronousAnalysis) analyseNow();
  gains_.beginFrame();
  const bool gained = attention::usesGains(options_.corrective.attention.order);
  regions_.beginFrame(picture_.toTrace(), gained ? gains_.byId(frame().extents.size()) : std::vector<float>{},
                      picture_.known());
}

void FrameLoop::analyseNow() {
  picture_.composite();
  const StageTimer timer(stats_, "analyse");
  regions_.setPriorities(analyzer_.analyzeNow({picture_.frame(), picture_.shareDisplay()}));
}

void FrameLoop::correct(Clock::time_point start, const FrameBudget& budget, const std::stop_token& stop) {
  using Kind = FrameBudget::Kind;
  if (budget.kind == Kind::samples) return correctSamples(budget.samples, stop);
  takePending();
  if (options_.threads == 0) return correctInline(budget, stop);
  if (budget.kind == Kind::converge) return correctAll(stop);
  const auto time = std::chrono::duration<double>(std::max(0.0, budget.time.count() - tailSeconds_));
  correctUntil(start + std::chrono::duration_cast<Clock::duration>(time), stop);
}

// Step 6 against the wall clock. What waits in the queue is taken even when drawing used up the time, else
// the tracers' work for a frame that is too slow would never be seen. All of it, but for the bound: a queue
// that grew from frame to frame would give older and older samples.
void FrameLoop::correctUntil(Clock::time_point deadline, const std::stop_token& stop) {
  const Clock::time_point latest = std::max(deadline, Clock::now()) + kLateTime;
  while (!stop.stop_requested()) {
    const Clock::time_point now = Clock::now();
    auto batch =
        now < deadline ? samples_.popUntil(std::min(deadline, now + kStopPollInterval)) : samples_.tryPop();
    if (batch) take(std::move(*batch));
    if (now >= latest || (now >= deadline && !batch)) return;
  }
}

// Step 6 without tracer threads. A virtual clock counts rays, so that a run repeats exactly.
void FrameLoop::correctInline(const FrameBudget& budget, const std::stop_token& stop) {
  const bool timed = budget.kind == FrameBudget::Kind::deadline;
  const auto raysAllowed = static_cast<std::uint64_t>(budget.time.count() * kVirtualRaysPerSecond);
  const std::uint64_t raysBefore = pool_.rays();
  while (!stop.stop_requested() && (!timed || pool_.rays() - raysBefore < raysAllowed) && pool_.runOne()) {
    while (auto batch = samples_.tryPop()) take(std::move(*batch));
  }
}

// Step 6 until every pixel on the mask is exact.
void FrameLoop::correctAll(const std::stop_token& stop) {
  while (!converged() && !stop.stop_requested()) {
    if (auto batch = samples_.popUntil(Clock::now() + kStopPollInterval)) take(std::move(*batch));
    pool_.check();
  }
}

// Step 6 for a number of samples: jobs are numbered in the order in which they are handed out, which does not
// depend on the number of tracers, so the batches are taken in that order and the last one is cut (design
// fact 10).
void FrameLoop::correctSamples(std::uint64_t count, const std::stop_token& stop) {
  std::uint64_t taken = takeInOrder(count);
  while (taken < count && !converged() && !stop.stop_requested()) {
    if (options_.threads == 0) pool_.runOne();
    auto batch = samples_.popUntil(Clock::now() + kStopPollInterval);
    pool_.check();
    if (!batch || batch->epoch != frame().epoch) continue;
    pending_.emplace(batch->sequence, std::move(*batch));
    taken += takeInOrder(count - taken);
  }
}

/// Takes what stands at the head of the order; the rest of a cut batch waits for the next frame of this
/// camera. Batches of before nextSequence_ are stragglers of a frame that took them as they came.
std::uint64_t FrameLoop::takeInOrder(std::uint64_t atMost) {
  std::uint64_t taken = 0;
  for (auto it = pending_.begin(); it != pending_.end() && it->first <= nextSequence_ && taken < atMost;
       it = pending_.begin()) {
    std::vector<core::Sample>& samples = it->second.samples;
    const auto cut = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(atMost - taken, samples.size()));
    core::SampleBatch head{it->second.epoch, it->second.sequence, {samples.begin(), samples.begin() + cut}};
    take(std::move(head));
    taken += static_cast<std::uint64_t>(cut);
    samples.erase(samples.begin(), samples.begin() + cut);
    if (!samples.empty()) break;
    pending_.erase(it);
  }
  return taken;
}

/// A frame without a sample budget follows one with it.
void FrameLoop::takePending() {
  for (auto& [sequence, batch] : pending_) take(std::move(batch));
  pending_.clear();
}

void FrameLoop::dropPending() {
  for (const auto& [sequence, batch] : pending_) stats_.samplesDropped += batch.samples.size();
  pending_.clear();
  nextSequence_ = 0;
}

void FrameLoop::take(core::SampleBatch&& batch) {
  if (batch.epoch == frame().epoch) nextSequence_ = std::max(nextSequence_, batch.sequence + 1);
  if (onBatch) onBatch(batch);
  noteGains(batch);
  picture_.take(batch);
  if (!sink_) return;
  const StageTimer timer(stats_, "record");
  sink_->batch(std::move(batch));
}

/// Before the batch is splatted. What the display shows where nothing is splatted yet is the base: what
/// approximates corrections there would hide that samples are wanted.
void FrameLoop::noteGains(const core::SampleBatch& batch) {
  if (batch.epoch != frame().epoch || !attention::usesGains(options_.corrective.attention.order)) return;
  const float exposure = std::exp2(picture_.settings().exposureEv);
  for (const core::Sample& s : batch.samples) {
    const core::Vec3 base(frame().baseAndId[frame().index(s.x, s.y)]);
    const render::CorrectionLayer::Splat* shown = layer().shownAt(s.x, s.y);
    const core::Vec3 before = shown ? base + shown->correction : base;
    gains_.add(s.id, core::displayedChange(exposure * before, exposure * (base + s.correction)));
  }
}

// Step 8. The analyzer keeps the picture, so the next composite goes into a new one.
void FrameLoop::feedAnalyzer() {
  if (!options_.asynchronousAnalysis || !mailbox_.wanted()) return;
  mailbox_.put({picture_.frame(), picture_.shareDisplay()});
}

void FrameLoop::record(bool newView) {
  if (!sink_) return;
  const StageTimer timer(stats_, "record");
  sink_->frame({picture_.frame(), newView, picture_.settings(),
                static_cast<float>(options_.corrective.attention.attention), picture_.shareDisplay()});
}

void FrameLoop::finishStats(Clock::time_point start, const FrameBudget& budget) {
  const std::chrono::duration<double> taken = Clock::now() - start;
  stats_.frameMs.push_back(1000 * taken.count());
  if (budget.missedAfter(taken)) ++stats_.missedDeadlines;
  stats_.nonDiffusePixels = frame().nonDiffusePixels;
  stats_.converged = converged();
  stats_.rays = pool_.rays();
  stats_.tracingSeconds = stats_.stageMs["correct"] / 1000;
}

}  // namespace saccade::app
