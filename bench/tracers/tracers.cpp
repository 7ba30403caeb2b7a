// Samples that reach the frame in a correction step of 50 ms with 1, 2, 4 and 6 tracers, beside Haber 2001,
// section 5 (2 processors 500-800, 4: 1,000-1,500, 6: 1,500-2,500). The camera moves, so that every frame
// starts anew; drawing and warping happen outside the 50 ms, as in the paper's figure. Usage: bench_tracers
// [SCENE.glb PATH.json] [FRAMES]
#include <cstdlib>

#include "bench/common.h"

namespace saccade::bench {
namespace {

int run(int argc, char** argv) {
  app::setupLog();
  printProvenance(argc, argv);
  const bool named = argc > 2;
  const auto workspace = openScene(named ? argv[1] : bundledScene("gallery"));
  const app::CameraPath path = app::CameraPath::read(named ? argv[2] : bundledPath("gallery"));
  const int frames = argc > 3 ? std::atoi(argv[3]) : 20;
  app::Headless gl({}, *workspace);
  for (const int tracers : {1, 2, 4, 6}) {
    app::FrameLoop loop(*workspace, *gl.renderer, {.threads = tracers, .asynchronousAnalysis = true});
    std::vector<double> samples, rays;
    for (int i = 0; i < frames; ++i) {
      const core::Camera camera = path.at(path.lengthSeconds() * i / frames);
      loop.step(camera, {}, app::FrameBudget::firstSamples(0));  // draw, age and warp; the tracers start
      const std::uint64_t samplesBefore = loop.stats().samplesTraced, raysBefore = loop.stats().rays;
      loop.step(camera, {}, app::FrameBudget::untilDeadline(std::chrono::milliseconds(50)));
      samples.push_back(static_cast<double>(loop.stats().samplesTraced - samplesBefore));
      rays.push_back(static_cast<double>(loop.stats().rays - raysBefore));
    }
    const Spread s = spread(samples);
    std::printf("%d tracers: %.0f samples in 50 ms (%.0f to %.0f), %.0f rays\n", tracers, s.median, s.min,
                s.max, spread(rays).median);
  }
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
