#include "bench/maps/point_reference.h"

#include <cstdio>
#include <span>
#include <string>

#include "bench/reference/kept_sums.h"
#include "core/content_hash.h"
#include "core/maps.h"
#include "raytrace/parallel_rows.h"
#include "raytrace/path_tracer.h"

namespace saccade::bench {
namespace {

constexpr int kGroups = 16;                   ///< that pathIrradiance splits its paths into
constexpr int kSamplesPerPass = 8 * kGroups;  ///< of each half
constexpr std::uint64_t kLeastSamplesPerHalf = 512;

/// Mean irradiance of one pass at all points: a picture one row high.
core::ImageRgb passAt(const raytrace::World& world, std::span<const raytrace::SurfacePoint> points,
                      const raytrace::PathOptions& options, const core::Progress& progress) {
  core::ImageRgb mean(static_cast<int>(points.size()), 1);
  raytrace::parallelRows(mean.width(), options.threads, progress, [&](int i, int) {
    raytrace::RayCounters counters;
    mean.at(i, 0) = raytrace::pathIrradiance(world, points[static_cast<std::size_t>(i)],
                                             static_cast<std::uint32_t>(i), options, counters)
                        .mean;
  });
  return mean;
}

std::vector<PointTruth> truthOf(const ReferenceSums& sums) {
  std::vector<PointTruth> out;
  const core::ImageRgb mean = sums.mean(), a = sums.half(0), b = sums.half(1);
  for (int i = 0; i < sums.width; ++i) {
    const double half = (double{core::luminance(a.at(i, 0))} - double{core::luminance(b.at(i, 0))}) / 2;
    out.push_back({mean.at(i, 0), half * half});
  }
  return out;
}

double squared(double x) { return x * x; }

}  // namespace

std::uint64_t pointReferenceKey(const core::Scene& scene, const PointTask& task) {
  core::ContentHash hash;
  hash.add(std::string("irradiance at points"));
  hash.add(raytrace::kPathTracerVersion);
  hash.add(kSamplesPerPass);
  hash.add(core::sceneKey(scene));
  hash.add(task.points);
  hash.add(task.bounces);
  hash.add(task.seed);
  return hash.value();
}

PointReference computePointReference(const app::Workspace& uncharted, const PointTask& task,
                                     const PointConfidence& confidence, int threads,
                                     const core::Progress& progress, core::Warnings& warnings) {
  PointReference reference;
  reference.key = pointReferenceKey(uncharted.scene, task);
  reference.points =
      raytrace::surfacePoints(*uncharted.world, static_cast<std::size_t>(task.points), task.seed);
  reference.reached = true;
  if (reference.points.empty()) return reference;
  SumsTask sums;
  sums.key = reference.key;
  sums.width = static_cast<int>(reference.points.size());
  sums.height = 1;
  sums.samplesPerPass = kSamplesPerPass;
  sums.leastSamplesPerHalf = kLeastSamplesPerHalf;
  sums.pass = [&](int half, std::uint64_t done, const core::Progress& inner) {
    raytrace::PathOptions options;
    options.samplesPerPixel = kSamplesPerPass;
    options.firstSample = done / kGroups;
    options.bounces = task.bounces;
    options.seed = seedOfHalf(ReferenceKind::points, task.seed, half);
    options.threads = threads;
    return passAt(*uncharted.world, reference.points, options, inner);
  };
  sums.error = [](const ReferenceSums& s) { return squared(noiseOf(truthOf(s))); };
  sums.wantedError = squared(confidence.noise);
  sums.capSeconds = confidence.capSeconds;
  sums.threads = threads;
  const KeptSums kept = keepSums(sums, progress, warnings);
  reference.truth = truthOf(kept.sums);
  reference.noise = noiseOf(reference.truth);
  reference.samplesPerPoint = kept.sums.samplesPerPixel();
  reference.seconds = kept.sums.seconds;
  reference.reached = kept.reached;
  return reference;
}

PointReference pointReferenceOf(const app::Workspace& uncharted, const PointTask& task,
                                const PointConfidence& confidence, const std::stop_token& stop) {
  PointReference reference;
  computeReported(stop, [&](int threads, const core::Progress& progress, core::Warnings& warnings) {
    reference = computePointReference(uncharted, task, confidence, threads, progress, warnings);
    if (reference.reached) return;
    char line[200];
    std::snprintf(line, sizeof line,
                  "reference: noise %.2g %% of the mean after %.0f s, not the %.2g %% asked for; it is taken "
                  "out of the errors, which scatter the more",
                  100 * reference.noise, reference.seconds, 100 * confidence.noise);
    warnings.emplace_back(line);
  });
  return reference;
}

}  // namespace saccade::bench
