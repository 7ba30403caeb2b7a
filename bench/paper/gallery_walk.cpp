#include "bench/paper/gallery_walk.h"

#include <algorithm>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr int kRates[] = {8, 25};
constexpr double kSeconds = 5;  ///< of each walk
constexpr double kQuickSeconds = 2;

/// Of one walk.
struct Walked {
  double p50 = 0, p95 = 0, p99 = 0, missed = 0;
  double samples = 0, samplesP5 = 0;
  std::map<std::string, double> stageMs;  ///< a frame's mean
};

Walked walk(const Stage& stage, const app::CameraPath& path, int fps, int frames) {
  const auto loop =
      pinnedLoop(stage, {.threads = stage.tracers, .seed = stage.seed, .asynchronousAnalysis = true});
  loop->step(path.at(0), kSize, app::FrameBudget::firstSamples(0));  // memory and shaders, once
  const auto budget = app::FrameBudget::untilDeadline(std::chrono::duration<double>(1.0 / fps));
  for (int i = 0; i < frames; ++i) loop->step(path.at(path.lengthSeconds() * i / frames), kSize, budget);
  app::RunStats stats = loop->stats();
  stats.frameMs.erase(stats.frameMs.begin());
  std::vector<std::uint64_t> samples(stats.samplesPerFrame.begin() + 1, stats.samplesPerFrame.end());
  std::sort(samples.begin(), samples.end());
  Walked walked{stats.framePercentileMs(0.5), stats.framePercentileMs(0.95), stats.framePercentileMs(0.99),
                static_cast<double>(stats.missedDeadlines)};
  walked.samples = static_cast<double>(samples[samples.size() / 2]);
  walked.samplesP5 = static_cast<double>(samples[samples.size() / 20]);
  for (const auto& [name, ms] : stats.stageMs) walked.stageMs[name] = ms / (frames + 1);
  return walked;
}

double bareDrawMs(const Stage& stage, const app::CameraPath& path, int frames) {
  std::vector<double> ms;
  for (int i = 0; i < frames; ++i) {
    const core::View view = stage.view(path.at(path.lengthSeconds() * i / frames), kSize);
    ms.push_back(1000 *
                 timed([&] { stage.gl->renderer->render(view, static_cast<std::uint64_t>(i) + 1, 10); }));
  }
  return spread(ms).median;
}

Record rateRecord(int fps, int frames, const std::vector<Walked>& walks) {
  const double budget = 1000.0 / fps;
  Value budgetValue = Value::count(budget);
  budgetValue.unit = "ms";
  Value missed = Value::milliseconds(each(walks, [](const Walked& w) { return w.missed; }));
  missed.unit.clear();
  Record record;
  record.key = "gallery-walk/" + std::to_string(fps) + "fps";
  record.labels = {{"fps", std::to_string(fps)}};
  record.at = {{"budget_ms", budget}};
  record.values = {
      {"budget", budgetValue},
      {"frame_p50", Value::milliseconds(each(walks, [](const Walked& w) { return w.p50; }))},
      {"frame_p95", Value::milliseconds(each(walks, [](const Walked& w) { return w.p95; }))},
      {"frame_p99", Value::milliseconds(each(walks, [](const Walked& w) { return w.p99; }))},
      {"p95_over_budget",
       Value::ratio(each(walks, [&](const Walked& w) { return w.p95 / budget; }), Better::lower)},
      {"missed", missed},
      {"frames", Value::count(frames)},
      {"samples_per_frame", Value::perFrame(each(walks, [](const Walked& w) { return w.samples; }))},
      {"samples_per_frame_p5", Value::perFrame(each(walks, [](const Walked& w) { return w.samplesP5; }))}};
  return record;
}

Record stagesRecord(int fps, const std::vector<Walked>& walks, const std::vector<double>& bare) {
  Record record;
  record.key = "gallery-walk/stages";
  record.labels = {{"fps", std::to_string(fps)}};
  record.values = {{"bare_draw", Value::milliseconds(bare)}};
  const std::pair<const char*, const char*> stages[] = {{"draw", "draw"},
                                                        {"warp_splat", "warp"},
                                                        {"correct", "correct"},
                                                        {"composite", "composite"},
                                                        {"aging", "age"}};
  for (const auto& [metric, stage] : stages) {
    record.values[metric] =
        Value::milliseconds(each(walks, [&](const Walked& w) { return w.stageMs.at(stage); }));
  }
  return record;
}

Record sceneRecord(const Stage& stage) {
  Record record;
  record.key = "gallery-walk/scene";
  record.labels = {{"scene", stage.name}};
  record.values = {{"triangles", Value::count(static_cast<double>(stage.workspace->scene.triangleCount()))},
                   {"nondiffuse", Value::count(stage.workspace->scene.idCount())},
                   {"tracers", Value::count(stage.tracers)}};
  return record;
}

}  // namespace

void measureGalleryWalk(Session& session) {
  const auto stage = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  session.add(sceneRecord(*stage), nullptr);
  const Pinned main(mainCores());
  const LoadWatch watch;
  const double seconds = session.quick() ? kQuickSeconds : kSeconds;
  std::vector<Walked> walks[2];
  std::vector<double> bare;
  alternate(3, kRepeats, session.stop(), [&](int variant, int round) {
    if (variant == 2) {
      session.say("gallery-walk: round " + std::to_string(round + 1) + " of " + std::to_string(kRepeats));
      const double ms = bareDrawMs(*stage, path, 50);
      if (round >= 0) bare.push_back(ms);
    } else {
      Walked walked = walk(*stage, path, kRates[variant], static_cast<int>(seconds * kRates[variant]));
      if (round >= 0) walks[variant].push_back(std::move(walked));
    }
  });
  for (int i = 0; i < 2; ++i)
    session.add(rateRecord(kRates[i], static_cast<int>(seconds * kRates[i]), walks[i]), &watch);
  session.add(stagesRecord(kRates[1], walks[1], bare), &watch);
}

}  // namespace saccade::bench
