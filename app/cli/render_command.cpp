// saccade render: one picture by one method.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "app/cli/console.h"
#include "app/cli/options.h"
#include "app/commands.h"
#include "app/session/frame_loop.h"
#include "app/session/headless.h"
#include "app/session/overlays.h"
#include "core/composite.h"
#include "core/image_io.h"
#include "raytrace/path_tracer.h"
#include "raytrace/reference.h"

namespace saccade::app {

namespace {

struct RenderOptions {
  SceneOptions scene;
  CameraOptions camera;
  RunOptions run;
  CorrectiveOptions corrective;
  ImageSize size;
  std::string output;
  std::string method = "corrective";
  std::string base = "baked";  ///< the one there is; scripts name it
  std::optional<double> budgetMs;
  std::optional<std::uint64_t> samples;
  bool converge = false;
  std::string aov;
  int bounces = 12;
  std::string lobes = "all";
  std::string diffuse = "lambert";
};

void checkOutput(const RenderOptions& o) {
  const std::string extension = std::filesystem::path(o.output).extension().string();
  if (extension != ".exr" && extension != ".png") {
    throw core::UsageError("-o " + o.output + ": the name must end in .exr (linear) or .png (display)");
  }
  const std::filesystem::path folder = std::filesystem::absolute(o.output).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw core::Error(folder.string() + ": no such folder; make it first (-o)");
}

bool wantsExr(const RenderOptions& o) { return std::filesystem::path(o.output).extension() == ".exr"; }

void writeLinear(const RenderOptions& o, const core::ImageRgb& linear) {
  if (wantsExr(o)) {
    core::writeExr(o.output, linear);
  } else {
    core::writePng(o.output, core::toDisplay(linear, o.run.exposureEv));
  }
}

void writeAov(const RenderOptions& o, const FrameLoop& loop) {
  const Aov aov = aovByName(o.aov);
  const AovImage image = aovImage(aov, loop);
  if (wantsExr(o)) {
    core::writeExrChannels(o.output, {{"Y", &image.values}});
  } else {
    core::writePng(o.output, aovPicture(image, {aov, image.values, o.corrective.maxAge}));
  }
}

FrameBudget budgetOf(const RenderOptions& o) {
  if (o.budgetMs) return FrameBudget::untilDeadline(std::chrono::duration<double, std::milli>(*o.budgetMs));
  if (o.samples) return FrameBudget::firstSamples(*o.samples);
  return FrameBudget::untilConverged();
}

RunStats renderCorrective(const RenderOptions& o, const Workspace& workspace, Headless& gl,
                          const core::Camera& camera) {
  FrameLoop loop(workspace, *gl.renderer,
                 {.corrective = o.corrective,
                  .threads = tracerThreads(o.run),
                  .seed = o.run.seed,
                  .exposureEv = o.run.exposureEv,
                  .probesAFrame = render::Approximation::kMostProbes});
  loop.step(camera, o.size, budgetOf(o), interruptToken());
  if (o.aov.empty()) {
    writeLinear(o, loop.linear());
  } else {
    writeAov(o, loop);
  }
  return loop.stats();
}

RunStats renderReference(const RenderOptions& o, const Workspace& workspace, Headless& gl,
                         const core::Camera& camera, bool trace) {
  RunStats stats;
  const auto start = std::chrono::steady_clock::now();
  const core::View view(camera, o.size.width, o.size.height, workspace.scene.bounds);
  const core::FramePtr frame = gl.renderer->render(view, 1, o.corrective.nMin);
  stats.stageMs["draw"] = millisecondsSince(start);
  stats.nonDiffusePixels = frame->nonDiffusePixels;
  raytrace::TraceAllResult reference;
  if (trace) {
    const auto traceStart = std::chrono::steady_clock::now();
    const raytrace::CorrectiveTracer tracer(
        *workspace.world, {.seed = o.run.seed, .samplesPerPixel = o.corrective.samplesPerPixel});
    ProgressBar bar("tracing");
    reference = raytrace::traceAll(tracer, *frame, tracerThreads(o.run),
                                   {[&](double fraction) { bar.show(fraction); }, interruptToken()});
    stats.stageMs["correct"] = millisecondsSince(traceStart);
    stats.tracingSeconds = stats.stageMs["correct"] / 1000;
    stats.samplesTraced = reference.traced;
    stats.fromDepth = reference.fromDepth;
    stats.rays = reference.counters.rays;
    stats.levels[core::Lattice::kMaxLevel] = reference.traced;
    stats.converged = reference.traced == frame->nonDiffusePixels;
  }
  writeLinear(o, core::compositeLinear(o.size.width, o.size.height, frame->baseAndId, reference.corrections));
  stats.frameMs.push_back(millisecondsSince(start));
  return stats;
}

RunStats renderPathTraced(const RenderOptions& o, const Workspace& workspace, const core::Camera& camera) {
  RunStats stats;
  const auto start = std::chrono::steady_clock::now();
  raytrace::PathOptions path;
  path.samplesPerPixel = o.corrective.samplesPerPixel;
  path.bounces = o.bounces;
  path.transport = o.lobes == "diffuse" ? raytrace::Transport::diffuse : raytrace::Transport::all;
  path.diffuse = o.diffuse == "burley" ? raytrace::DiffuseModel::burley : raytrace::DiffuseModel::lambert;
  path.seed = o.run.seed;
  path.threads = tracerThreads(o.run);
  ProgressBar bar("path tracing");
  const core::View view(camera, o.size.width, o.size.height, workspace.scene.bounds);
  const raytrace::PathResult result =
      raytrace::tracePaths(*workspace.world, view, path, {[&](double f) { bar.show(f); }, interruptToken()});
  writeLinear(o, result.radiance);
  stats.frameMs.push_back(millisecondsSince(start));
  stats.stageMs["path"] = stats.frameMs.back();
  stats.rays = result.counters.rays;
  stats.tracingSeconds = stats.frameMs.back() / 1000;
  return stats;
}

int render(const RenderOptions& o) {
  checkOutput(o);
  if (o.budgetMs.has_value() + o.samples.has_value() + (o.converge ? 1 : 0) > 1) {
    throw core::UsageError("--budget-ms, --samples and --converge exclude one another");
  }
  if (o.corrective.approximation && o.method != "corrective")
    throw core::UsageError("--approximation needs --method corrective");
  if (!o.aov.empty()) {
    aovByName(o.aov);
    if (o.method != "corrective") throw core::UsageError("--aov needs --method corrective");
  }
  const std::stop_token stop = interruptToken();
  RunStats stats;
  if (o.method == "path") {
    const auto workspace = openWithoutMaps(o.scene);
    stats = renderPathTraced(o, *workspace, chooseCamera(workspace->scene, o.camera));
  } else {
    const auto workspace =
        openWorkspace(o.scene, {.threads = tracerThreads(o.run), .seed = o.run.seed}, stop);
    const core::Camera camera = chooseCamera(workspace->scene, o.camera);
    Headless gl(o.run, *workspace);
    stats = o.method == "corrective" ? renderCorrective(o, *workspace, gl, camera)
                                     : renderReference(o, *workspace, gl, camera, o.method == "raytrace");
    stats.context = gl.context->name();
    stats.renderer = gl.context->renderer();
  }
  stats.seed = o.run.seed;
  stats.threads = tracerThreads(o.run);
  if (!o.run.statsFile.empty()) writeStats(o.run.statsFile, stats);
  if (stop.stop_requested()) throw core::Error("interrupted; " + o.output + " holds what was done by then");
  return 0;
}

}  // namespace

void addRenderCommand(CLI::App& program, Run& run) {
  CLI::App* command =
      program.add_subcommand("render", "Render one picture to an EXR (linear) or PNG (display) file");
  auto o = std::make_shared<RenderOptions>();
  addSceneOptions(*command, o->scene);
  command->add_option("-o,--output", o->output, "Image to write: .exr or .png")->required();
  command
      ->add_option(
          "--method", o->method,
          "base: illumination maps alone; corrective: with corrections where people look; raytrace: the same "
          "corrections for every pixel in scanline order; path: unbiased path tracing")
      ->check(CLI::IsMember({"base", "corrective", "raytrace", "path"}))
      ->capture_default_str();
  command
      ->add_option("--base", o->base, "What base, corrective and raytrace stand on: baked illumination maps")
      ->check(CLI::IsMember({"baked"}))
      ->capture_default_str();
  addSizeOption(*command, o->size);
  command->add_option("--budget-ms", o->budgetMs, "corrective: milliseconds for the frame")
      ->check(CLI::PositiveNumber);
  command->add_option("--samples", o->samples,
                      "corrective: the first N samples of the schedule, on any number of threads");
  command->add_flag("--converge", o->converge,
                    "corrective: until every non-diffuse pixel is exact (the default)");
  command->add_option("--aov", o->aov, "Write this instead of the picture: " + aovList());
  command->add_option("--bounces", o->bounces, "path: longest path in bounces")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command
      ->add_option("--lobes", o->lobes,
                   "path: all lobes, or only Lambert's (what the illumination maps hold)")
      ->check(CLI::IsMember({"all", "diffuse"}))
      ->capture_default_str();
  command
      ->add_option("--diffuse", o->diffuse,
                   "path: Lambert as glTF and the maps have it, or Burley's as Blender's Principled BSDF, to "
                   "compare with Cycles")
      ->check(CLI::IsMember({"lambert", "burley"}))
      ->capture_default_str();
  addCameraOptions(*command, o->camera);
  addCorrectiveOptions(*command, o->corrective);
  addRunOptions(*command, o->run);
  command->callback([o, &run] { run = [o] { return render(*o); }; });
}

}  // namespace saccade::app
