// saccade walk: the viewer, in a window or off screen.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "app/cli/console.h"
#include "app/cli/options.h"
#include "app/cli/walk_options.h"
#include "app/commands.h"
#include "app/recording/session_recorder.h"
#include "app/session/camera_path.h"
#include "app/session/frame_loop.h"
#include "app/session/headless.h"
#include "app/session/kept_cache.h"
#include "app/viewer/viewer.h"
#include "core/image_io.h"

namespace saccade::app {

namespace {

CameraPath pathOf(const WalkOptions& o, const core::Scene& scene) {
  if (!o.path.empty()) return CameraPath::read(o.path);
  const core::Camera camera = chooseCamera(scene, o.camera);
  return o.orbit ? CameraPath::orbit(camera, kOrbitPeriodSeconds) : CameraPath::still(camera);
}

FrameBudget budgetOf(const WalkOptions& o) {
  if (o.samples) return FrameBudget::firstSamples(*o.samples);
  if (o.budgetMs) return FrameBudget::untilDeadline(std::chrono::duration<double, std::milli>(*o.budgetMs));
  return FrameBudget::untilDeadline(std::chrono::duration<double>(1.0 / o.fps));
}

void writeFrame(const WalkOptions& o, int number, const core::ImageRgba8& image) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05d.png", number);
  core::writePng(std::filesystem::path(o.framesFolder) / name, image);
}

void report(const RunStats& s) {
  std::printf(
      "%zu frames: p50 %.1f ms, p95 %.1f ms, p99 %.1f ms; %llu missed deadlines; %llu samples traced, %llu "
      "reused%s\n",
      s.frameMs.size(), s.framePercentileMs(0.5), s.framePercentileMs(0.95), s.framePercentileMs(0.99),
      static_cast<unsigned long long>(s.missedDeadlines), static_cast<unsigned long long>(s.samplesTraced),
      static_cast<unsigned long long>(s.samplesReused), s.converged ? "; converged" : "");
}

int walkHeadless(const WalkOptions& o, const Workspace& workspace) {
  const CameraPath path = pathOf(o, workspace.scene);
  const double seconds =
      o.seconds.value_or(path.lengthSeconds() > 0 ? path.lengthSeconds() : kOrbitPeriodSeconds);
  const int frames = std::max(1, static_cast<int>(std::lround(seconds * o.fps)));
  const std::stop_token stop = interruptToken();
  Headless gl(o.run, workspace);
  const int threads = tracerThreads(o.run);
  const auto recorder = makeRecorder(o, workspace, *gl.context);
  FrameLoop loop(workspace, *gl.renderer,
                 {o.corrective, threads, o.run.seed, o.run.exposureEv, threads > 0 && !o.samples});
  if (recorder) loop.recordTo(*recorder);
  std::optional<KeptCache> kept;
  if (o.keepCache) kept.emplace(workspace, o.scene, o.corrective, o.run.seed).restore(loop);
  if (!o.framesFolder.empty()) std::filesystem::create_directories(o.framesFolder);
  ProgressBar bar("walking");
  for (int i = 0; i < frames && !stop.stop_requested(); ++i) {
    if (recorder) recorder->setSeconds(i / o.fps);
    loop.step(path.at(i / o.fps), o.size, budgetOf(o), stop);
    if (!o.framesFolder.empty()) writeFrame(o, i, loop.display());
    bar.show((i + 1.0) / frames);
  }
  if (o.converge && !stop.stop_requested()) {
    if (recorder) recorder->setSeconds(frames / o.fps);
    loop.step(loop.frame().view.camera(), o.size, FrameBudget::untilConverged(), stop);
  }
  if (!o.output.empty()) writeLast(o, loop);
  if (kept) kept->keep(loop);
  RunStats stats = loop.stats();
  stats.context = gl.context->name();
  stats.renderer = gl.context->renderer();
  report(stats);
  if (!o.run.statsFile.empty()) writeStats(o.run.statsFile, stats);
  return finishRecording(recorder.get(), o.record);
}

int walk(const WalkOptions& o) {
  if (!o.headless) return runViewer(o);
  if (o.scene.path.empty())
    throw core::UsageError("walk --headless needs a SCENE; only the window opens without");
  return walkHeadless(o, *openWorkspace(o.scene, bakeOf(o), interruptToken()));
}

}  // namespace

WalkOptions laterVisit(const WalkOptions& first, const std::filesystem::path& scene) {
  WalkOptions later = first;
  later.scene = {};
  later.scene.path = scene.string();
  later.scene.quality = first.scene.quality;
  later.scene.mapsMegabytes = first.scene.mapsMegabytes;
  later.scene.load.limits = first.scene.load.limits;
  later.camera = {};
  later.orbit = false;
  later.path.clear();
  later.record.clear();
  return later;
}

BakeRequest bakeOf(const WalkOptions& o) {
  return {.threads = std::max(1, tracerThreads(o.run)), .seed = o.run.seed};
}

std::unique_ptr<SessionRecorder> makeRecorder(const WalkOptions& o, const Workspace& workspace,
                                              const render::GlContext& context) {
  if (o.record.empty()) return nullptr;
  const std::filesystem::path maps = mapsPath(workspace.maps.key, o.scene, bakeOf(o));
  return std::make_unique<SessionRecorder>(o.record,
                                           describeSession(o.scene, maps, workspace, o.run, o.corrective,
                                                           {context.name(), context.renderer(), cpuName()}));
}

int finishRecording(SessionRecorder* recorder, const std::string& file) {
  if (!recorder) return 0;
  const SessionRecorder::Outcome outcome = recorder->finish();
  if (!outcome.complete) return 1;
  spdlog::info("recorded {} frames and {} samples into {}: saccade replay shows them", outcome.frames,
               outcome.samples, file);
  return 0;
}

void writeLast(const WalkOptions& o, FrameLoop& loop) {
  if (std::filesystem::path(o.output).extension() == ".exr") {
    core::writeExr(o.output, loop.linear());
  } else {
    core::writePng(o.output, loop.display());
  }
}

void addWalkCommand(CLI::App& program, Run& run) {
  CLI::App* command =
      program.add_subcommand("walk", "Walk through a scene: in a window, or off screen along a path");
  auto o = std::make_shared<WalkOptions>();
  addSceneOptions(*command, o->scene)->required(false);
  command->add_flag("--headless", o->headless, "No window: follow a path and report");
  auto* orbit =
      command->add_flag("--orbit", o->orbit, "Circle once around what the camera looks at, in 12 seconds");
  command->add_option("--path", o->path, "Camera path: JSON list of {t, eye, at, up, fov}")
      ->check(CLI::ExistingFile)
      ->excludes(orbit);
  command->add_option("--fps", o->fps, "Frame rate to keep")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--seconds", o->seconds, "Length of the walk (default: the path's)")
      ->check(CLI::PositiveNumber);
  command->add_option("--frames", o->framesFolder, "Write every frame to this folder as PNG");
  command
      ->add_option("--record", o->record,
                   "Record cameras, samples, settings and picture hashes into this SQLite file; an earlier "
                   "recording of that name is replaced")
      ->option_text("FILE");
  command->add_option("-o,--output", o->output, "Write the last frame: .exr (linear) or .png");
  command->add_flag("--converge", o->converge, "After the walk, rest until every non-diffuse pixel is exact");
  command->add_flag(
      "--keep-cache", o->keepCache,
      "Keep the cached samples for the next visit of this scene, and begin with those of the last");
  command->add_option("--budget-ms", o->budgetMs, "Milliseconds a frame, instead of --fps")
      ->check(CLI::PositiveNumber);
  command->add_option("--samples", o->samples,
                      "Samples a frame, instead of a time: repeats exactly on any number of threads");
  addSizeOption(*command, o->size);
  command->add_option("--ui-screenshot", o->uiScreenshot,
                      "Window: write what it shows when it closes, panel included");
  command->add_option("--exit-after", o->exitAfterSeconds, "Window: close after so many seconds")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--ui-scale", o->uiScale,
                   "Window: size of letters and panel (default: what the display says)")
      ->check(CLI::Range(0.5, 4.0));
  command->add_option("--overlay", o->overlay, "Window: overlay to start with: " + aovList());
  addCameraOptions(*command, o->camera);
  o->corrective.approximation = true;  // for people; measurements and stills ask for it
  addCorrectiveOptions(*command, o->corrective);
  addRunOptions(*command, o->run);
  command->callback([o, command, &run] {
    const auto given = [command](const char* option) { return command->count(option) > 0; };
    o->given = {.size = given("--size"),
                .fps = given("--fps"),
                .attention = given("--attention"),
                .exposure = given("--exposure"),
                .delta = given("--delta"),
                .approximation = given("--approximation")};
    run = [o] { return walk(*o); };
  });
}

}  // namespace saccade::app
