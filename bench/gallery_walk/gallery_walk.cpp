// Does the frame rate hold in the museum hall? 512x512, moving along the bundled path, at the paper's 8
// frames a second and at 25, beside the bare draw of the same triangles (draw and read-back only, no
// tracers). The runs alternate. Usage: bench_gallery_walk [REPEATS] [SECONDS] [TRACERS]
#include <cstdlib>

#include "bench/common.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};

struct WalkResult {
  app::RunStats stats;
  double samplesP50 = 0, samplesP5 = 0;
};

WalkResult walk(const app::Workspace& workspace, render::BaseRenderer& renderer, const app::CameraPath& path,
                double fps, double seconds, int tracers) {
  app::FrameLoop loop(workspace, renderer, {.threads = tracers, .asynchronousAnalysis = true});
  const int frames = static_cast<int>(seconds * fps);
  loop.step(path.at(0), kSize, app::FrameBudget::firstSamples(0));  // memory and shaders, once
  const auto budget = app::FrameBudget::untilDeadline(std::chrono::duration<double>(1 / fps));
  for (int i = 0; i < frames; ++i) loop.step(path.at(path.lengthSeconds() * i / frames), kSize, budget);
  WalkResult result{loop.stats()};
  result.stats.frameMs.erase(result.stats.frameMs.begin());
  std::vector<std::uint64_t> samples = result.stats.samplesPerFrame;
  std::sort(samples.begin() + 1, samples.end());
  result.samplesP50 = static_cast<double>(samples[samples.size() / 2]);
  result.samplesP5 = static_cast<double>(samples[1 + samples.size() / 20]);
  return result;
}

double bareDrawMs(const app::Workspace& workspace, render::BaseRenderer& renderer,
                  const app::CameraPath& path, int frames) {
  std::vector<double> ms;
  for (int i = 0; i < frames; ++i) {
    const core::View view(path.at(path.lengthSeconds() * i / frames), kSize.width, kSize.height,
                          workspace.scene.bounds);
    ms.push_back(1000 * timed([&] { renderer.render(view, static_cast<std::uint64_t>(i) + 1, 10); }));
  }
  return spread(ms).median;
}

void printWalk(double fps, const WalkResult& r) {
  const double budget = 1000 / fps;
  std::printf(
      "%2.0f fps (budget %.0f ms): p50 %.1f, p95 %.1f, p99 %.1f ms, p95/budget %.3f; missed %llu of %zu; new "
      "samples a "
      "frame: median %.0f, 5th percentile %.0f\n",
      fps, budget, r.stats.framePercentileMs(0.5), r.stats.framePercentileMs(0.95),
      r.stats.framePercentileMs(0.99), r.stats.framePercentileMs(0.95) / budget,
      static_cast<unsigned long long>(r.stats.missedDeadlines), r.stats.frameMs.size(), r.samplesP50,
      r.samplesP5);
  std::printf("   ms a frame:");
  for (const auto& [stage, ms] : r.stats.stageMs) {
    std::printf(" %s %.2f", stage.c_str(), ms / static_cast<double>(r.stats.frameMs.size()));
  }
  std::printf("\n");
}

int run(int argc, char** argv) {
  app::setupLog();
  printProvenance(argc, argv);
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 5;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 6;
  const int tracers = argc > 3 ? std::atoi(argv[3]) : app::tracerThreads({});
  const auto workspace = openScene(bundledScene("gallery"));
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  app::RunOptions options;
  options.threads = tracers;
  app::Headless gl(options, *workspace);
  std::printf("%zu triangles, %u non-diffuse objects, %d tracers, %s\n", workspace->scene.triangleCount(),
              workspace->scene.idCount(), tracers, gl.context->renderer().c_str());
  bareDrawMs(*workspace, *gl.renderer, path, 20);  // warm-up
  for (int i = 0; i < repeats; ++i) {
    std::printf("bare draw and read-back: %.1f ms\n", bareDrawMs(*workspace, *gl.renderer, path, 50));
    for (const double fps : {8.0, 25.0})
      printWalk(fps, walk(*workspace, *gl.renderer, path, fps, seconds, tracers));
  }
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
