#include "bench/recording/recording.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/recording/session_recorder.h"
#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr double kFps = 25;
constexpr double kSeconds = 4;  ///< of each walk
constexpr double kQuickSeconds = 1;

/// Of one walk.
struct Walked {
  double p95 = 0, samples = 0;
  double handOverMs = 0, writerShare = 0;  ///< a frame's; of the walk's time
  double bytesPerFrame = 0;
  double atRiskMs = 0;
};

/// Of a session that nobody replays: any path of the maps will do.
app::SessionInfo infoOf(const Stage& stage) {
  app::SceneOptions scene;
  scene.path = stage.workspace->scene.path;
  return app::describeSession(scene, scene.path, *stage.workspace, {}, {},
                              {stage.gl->context->name(), stage.gl->context->renderer(), app::cpuName()});
}

Walked walk(const Stage& stage, const app::CameraPath& path, int frames, app::SessionRecorder* recorder) {
  const auto loop =
      pinnedLoop(stage, {.threads = stage.tracers, .seed = stage.seed, .asynchronousAnalysis = true});
  if (recorder) loop->recordTo(*recorder);
  const auto budget = app::FrameBudget::untilDeadline(std::chrono::duration<double>(1 / kFps));
  for (int i = 0; i < frames; ++i) {
    if (recorder) recorder->setSeconds(i / kFps);
    loop->step(path.at(path.lengthSeconds() * i / frames), kSize, budget);
  }
  const app::RunStats& stats = loop->stats();
  std::vector<std::uint64_t> samples = stats.samplesPerFrame;
  std::sort(samples.begin(), samples.end());
  Walked walked;
  walked.p95 = stats.framePercentileMs(0.95);
  walked.samples = static_cast<double>(samples[samples.size() / 2]);
  if (const auto found = stats.stageMs.find("record"); found != stats.stageMs.end())
    walked.handOverMs = found->second / frames;
  return walked;
}

Walked walkRecorded(const Stage& stage, const app::CameraPath& path, int frames,
                    const std::filesystem::path& file) {
  std::optional<app::SessionRecorder> recorder;
  {
    const Pinned workers(workerCores(1));  // threads inherit it
    recorder.emplace(file, infoOf(stage));
  }
  Walked walked = walk(stage, path, frames, &*recorder);
  const app::SessionRecorder::Outcome outcome = recorder->finish();
  if (!outcome.complete) throw core::Error("the recording experiment needs room in " + file.string());
  walked.atRiskMs = 1000 * outcome.longestAtRiskSeconds;
  walked.writerShare = outcome.writerCpuSeconds * kFps / frames;
  walked.bytesPerFrame = static_cast<double>(std::filesystem::file_size(file)) / frames;
  std::filesystem::remove(file);
  return walked;
}

double medianOf(const std::vector<double>& values) { return spread(values).median; }

}  // namespace

void measureRecording(Session& session) {
  const auto stage = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  const std::filesystem::path file = std::filesystem::path(session.options().folder) / "recording.session";
  const Pinned main(mainCores());
  const LoadWatch watch;
  const int frames = static_cast<int>((session.quick() ? kQuickSeconds : kSeconds) * kFps);
  std::vector<Walked> walks[2];
  alternate(2, kRepeats, session.stop(), [&](int recorded, int round) {
    Walked walked =
        recorded == 1 ? walkRecorded(*stage, path, frames, file) : walk(*stage, path, frames, nullptr);
    if (round >= 0) walks[recorded].push_back(walked);
  });
  const auto handOver = each(walks[1], [](const Walked& w) { return w.handOverMs; });
  const auto bytes = each(walks[1], [](const Walked& w) { return w.bytesPerFrame; });
  const auto p95 = [](const Walked& w) { return w.p95; };
  const auto samples = [](const Walked& w) { return w.samples; };
  Record record;
  record.key = "recording/gallery";
  record.labels = {{"scene", stage->name}};
  record.at = {{"budget_ms", 1000 / kFps}};
  record.values = {
      {"hand_over", Value::milliseconds(handOver)},
      {"share", Value::ratio(each(walks[1], [](const Walked& w) { return w.handOverMs * kFps / 1000; }),
                             Better::lower)},
      {"writer_share",
       Value::ratio(each(walks[1], [](const Walked& w) { return w.writerShare; }), Better::lower)},
      {"at_risk", Value::milliseconds(each(walks[1], [](const Walked& w) { return w.atRiskMs; }))},
      {"frame_p95", Value::milliseconds(each(walks[1], p95))},
      {"frame_p95_without", Value::milliseconds(each(walks[0], p95))},
      {"samples_per_frame", Value::perFrame(each(walks[1], samples))},
      {"samples_per_frame_without", Value::perFrame(each(walks[0], samples))},
      {"bytes_per_frame", Value::bytes(medianOf(bytes))},
      {"bytes_per_second", Value::bytes(medianOf(bytes) * kFps)}};
  session.add(record, &watch);
}

}  // namespace saccade::bench
