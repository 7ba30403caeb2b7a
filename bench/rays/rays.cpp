// How much of Embree's speed is left in the corrective loop? Rays per core and second, shadow rays included,
// over a bare rtcIntersect1/rtcOccluded1 loop that replays the very same rays in the same order. One thread;
// the two alternate. Usage: bench_rays [SCENE.glb] [REPEATS]
#include <cstdlib>

#include "bench/common.h"
#include "core/corrective/queues.h"
#include "raytrace/ray_log.h"

namespace saccade::bench {
namespace {

/// All jobs of the frame in the queue's order, as a tracer thread does them.
std::uint64_t correctiveLoop(const raytrace::CorrectiveTracer& tracer, const core::FramePtr& frame,
                             raytrace::RayLog* log, std::uint64_t& samples) {
  core::RegionQueue regions(64);
  regions.beginFrame(frame);
  raytrace::RayCounters counters;
  counters.log = log;
  samples = 0;
  while (const auto job = regions.tryPop()) {
    core::SampleBatch batch;
    core::forEachPixel(*job, [&](int x, int y) {
      batch.samples.push_back(tracer.trace(*frame, x, y, job->begin.level, counters));
    });
    samples += batch.samples.size();
  }
  return counters.rays;
}

int run(int argc, char** argv) {
  app::setupLog();
  printProvenance(argc, argv);
  const auto workspace = openScene(argc > 1 ? argv[1] : bundledScene("gallery"));
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 5;
  app::Headless gl({}, *workspace);
  const core::FramePtr frame =
      gl.renderer->render(core::View(workspace->scene.cameras[0], 512, 512, workspace->scene.bounds), 1, 10);
  const raytrace::CorrectiveTracer tracer(*workspace->world, {});
  raytrace::RayLog log;
  std::uint64_t samples = 0;
  const std::uint64_t rays = correctiveLoop(tracer, frame, &log, samples);  // warm-up, and the log
  std::vector<double> loop, bare, ratio;
  for (int i = 0; i < repeats; ++i) {
    loop.push_back(timed([&] { correctiveLoop(tracer, frame, nullptr, samples); }));
    bare.push_back(timed([&] { raytrace::replayRays(*workspace->world, log); }));
    ratio.push_back(bare.back() / loop.back());
  }
  const double n = static_cast<double>(rays);
  const Spread l = spread(loop), b = spread(bare), r = spread(ratio);
  std::printf("%zu triangles, %llu samples, %llu rays (%.2f a sample)\n", workspace->scene.triangleCount(),
              static_cast<unsigned long long>(samples), static_cast<unsigned long long>(rays),
              n / static_cast<double>(samples));
  std::printf("corrective loop %.2f Mray/s, bare replay %.2f Mray/s, ratio %.3f (%.3f to %.3f)\n",
              n / l.median / 1e6, n / b.median / 1e6, r.median, r.min, r.max);
  std::printf("in 50 ms on one core: %.0f samples, %.0f rays\n",
              0.05 * static_cast<double>(samples) / l.median, 0.05 * n / l.median);
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
