#include "bench/moving/walk_trial.h"

#include <cassert>
#include <numeric>

#include "bench/harness/trials.h"
#include "core/metrics/comparison.h"
#include "core/metrics/flip.h"

namespace saccade::bench {
namespace {

/// What the frames after `first` added.
app::RunStats since(const app::RunStats& first, app::RunStats all) {
  all.frameMs.erase(all.frameMs.begin(), all.frameMs.begin() + std::ssize(first.frameMs));
  all.samplesPerFrame.erase(all.samplesPerFrame.begin(),
                            all.samplesPerFrame.begin() + std::ssize(first.samplesPerFrame));
  all.missedDeadlines -= first.missedDeadlines;
  all.samplesTraced -= first.samplesTraced;
  all.samplesReused -= first.samplesReused;
  all.samplesDropped -= first.samplesDropped;
  all.rays -= first.rays;
  all.tracingSeconds -= first.tracingSeconds;
  return all;
}

/// Every figure that addErrors() reports.
void addTo(Grade& sum, const Grade& more, double factor) {
  for (double core::Comparison::*figure :
       {&core::Comparison::rmse, &core::Comparison::relmse, &core::Comparison::psnr,
        &core::Comparison::maxAbs, &core::Comparison::ssim, &core::Comparison::flip,
        &core::Comparison::flipMedian, &core::Comparison::flipP95})
    sum.errors.*figure += factor * (more.errors.*figure);
  sum.flipSalient += factor * more.flipSalient;
}

}  // namespace

WalkResult walkOnce(Walker& walker, const app::CameraPath& path, const Schedule& schedule) {
  const std::chrono::duration<double> budget(schedule.budgetSeconds());
  WalkResult result;
  result.shots.resize(static_cast<std::size_t>(schedule.keyViews()));
  app::RunStats first;
  for (int i = 0; i < schedule.frames(); ++i) {
    walker.frame(path.at(schedule.seconds(i)), budget);
    if (i == 0) first = walker.stats();
    const int next = i + 1 < schedule.frames() ? schedule.keyView(i + 1) : -1, here = schedule.keyView(i);
    if (here >= 0) {
      Shot& shot = result.shots[static_cast<std::size_t>(here)];
      shot.linear = walker.linear();
      shot.display = walker.display();
    }
    if (next >= 0) result.shots[static_cast<std::size_t>(next)].before = walker.display();
  }
  result.stats = since(first, walker.stats());
  return result;
}

Grade meanGrade(const WalkResult& walk, const std::vector<Grader>& truths) {
  assert(walk.shots.size() == truths.size());
  Grade mean;
  mean.errors.ssim = 0;
  for (std::size_t i = 0; i < truths.size(); ++i)
    addTo(mean, truths[i].grade(walk.shots[i].linear), 1 / static_cast<double>(truths.size()));
  return mean;
}

double stepOf(const WalkResult& walk) {
  double sum = 0;
  for (const Shot& shot : walk.shots) sum += core::meanOf(core::flip(shot.before, shot.display));
  return sum / static_cast<double>(walk.shots.size());
}

Metrics speedOf(const WalkResult& walk) {
  const app::RunStats& s = walk.stats;
  const auto frames = static_cast<double>(s.frameMs.size());
  const double seconds = std::accumulate(s.frameMs.begin(), s.frameMs.end(), 0.0) / 1000;
  const std::vector<double> samples(s.samplesPerFrame.begin(), s.samplesPerFrame.end());
  return {{"frame_p50", s.framePercentileMs(0.50)},
          {"frame_p95", s.framePercentileMs(0.95)},
          {"frame_p99", s.framePercentileMs(0.99)},
          {"missed_share", static_cast<double>(s.missedDeadlines) / frames},
          {"samples_per_second", static_cast<double>(s.samplesTraced) / seconds},
          {"rays_per_second", static_cast<double>(s.rays) / seconds},
          {"samples_per_frame", spread(samples).median},
          {"reused_per_frame", static_cast<double>(s.samplesReused) / frames}};
}

Value speedValue(const std::string& name, const std::vector<double>& repeats) {
  if (name.starts_with("frame_p")) return Value::milliseconds(repeats);
  Value value = Value::rate(repeats);
  if (name.ends_with("_per_second")) return value;
  if (name.starts_with(
          "missed_share")) {  // no ratio of two figures: it depends on machine and load as times do
    value.unit = "";
    value.better = Better::lower;
    return value;
  }
  assert(name.ends_with("_per_frame"));
  value.unit = "1/frame";
  return value;
}

}  // namespace saccade::bench
