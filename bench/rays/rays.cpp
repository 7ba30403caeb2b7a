#include "bench/rays/rays.h"

#include "bench/harness/method.h"
#include "core/corrective/queues.h"
#include "raytrace/ray_log.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr double kFrameSeconds = 0.05;  ///< Haber 2001, section 5, counts samples in 50 ms

/// All jobs of a frame in the queue's order, as a tracer thread does them.
std::uint64_t correctiveLoop(const raytrace::CorrectiveTracer& tracer, const core::FramePtr& frame,
                             int jobSize, raytrace::RayCounters& counters) {
  core::RegionQueue regions(jobSize);
  regions.beginFrame(frame);
  std::uint64_t samples = 0;
  while (const auto job = regions.tryPop()) {
    core::SampleBatch batch;
    std::vector<core::Pixel> pixels;
    core::forEachPixel(*job, [&](int x, int y) { pixels.push_back({x, y}); });
    tracer.trace(*frame, pixels, job->begin.level, counters, batch.samples);
    samples += batch.samples.size();
  }
  return samples;
}

struct Rates {
  std::vector<double> loop, bare;  ///< rays a second
  std::uint64_t samples = 0, rays = 0;
};

Rates alternateLoops(const Stage& stage, const core::FramePtr& frame, const std::stop_token& stop) {
  const raytrace::CorrectiveTracer tracer(*stage.workspace->world, {.seed = stage.seed});
  const int jobSize = app::CorrectiveOptions{}.jobSize;
  raytrace::RayLog log;
  raytrace::RayCounters logged;
  logged.log = &log;
  Rates rates;
  rates.samples = correctiveLoop(tracer, frame, jobSize, logged);
  rates.rays = logged.rays;
  const auto n = static_cast<double>(rates.rays);
  alternate(2, kRepeats, stop, [&](int variant, int round) {
    raytrace::RayCounters counters;
    const double seconds = variant == 0 ? timed([&] { correctiveLoop(tracer, frame, jobSize, counters); })
                                        : timed([&] { raytrace::replayRays(*stage.workspace->world, log); });
    if (round >= 0) (variant == 0 ? rates.loop : rates.bare).push_back(n / seconds);
  });
  return rates;
}

Record recordOf(const Stage& stage, const Rates& rates) {
  const double raysPerSample = static_cast<double>(rates.rays) / static_cast<double>(rates.samples);
  Value raysInFrame = Value::rate(rates.loop).times(kFrameSeconds);
  Value samplesInFrame = raysInFrame.times(1 / raysPerSample);
  samplesInFrame.unit = raysInFrame.unit = "1/50 ms";
  Record record;
  record.key = "rays/" + stage.name;
  record.labels = {{"scene", stage.name}};
  record.values = {{"loop", Value::rate(rates.loop)},
                   {"bare", Value::rate(rates.bare)},
                   {"ratio", Value::ratio(ratios(rates.loop, rates.bare), Better::higher)},
                   {"samples_in_50ms", samplesInFrame},
                   {"rays_in_50ms", raysInFrame},
                   {"rays_per_sample", Value::count(raysPerSample, Better::lower)},
                   {"samples", Value::count(static_cast<double>(rates.samples))},
                   {"triangles", Value::count(static_cast<double>(stage.workspace->scene.triangleCount()))}};
  return record;
}

}  // namespace

void measureRays(Session& session) {
  std::vector<std::string> scenes = session.options().scenes;
  if (scenes.empty()) scenes = {bundledScene("gallery"), bundledScene("cornell"), bundledScene("table")};
  for (const std::string& file : scenes) {
    session.say("rays: " + sceneName(file));
    const auto stage = openStage(file, "preview", session.options().seed, session.stop());
    const Pinned main(mainCores());
    const core::FramePtr frame = stage->gl->renderer->render(
        stage->view(stage->workspace->scene.cameras[0], kSize), 1, app::CorrectiveOptions{}.nMin);
    const LoadWatch watch;
    const Rates rates = alternateLoops(*stage, frame, session.stop());
    session.add(recordOf(*stage, rates), &watch);
  }
}

}  // namespace saccade::bench
