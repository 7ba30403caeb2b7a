#include "bench/maps/point_reference.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>

#include "app/cli/console.h"
#include "bench/harness/trials.h"
#include "bench/reference/reference.h"
#include "bench/reference/sums.h"
#include "core/content_hash.h"
#include "core/maps.h"
#include "core/math/random.h"
#include "raytrace/parallel_rows.h"
#include "raytrace/path_tracer.h"

namespace saccade::bench {
namespace {

constexpr int kGroups = 16;                          ///< that pathIrradiance splits its paths into
constexpr int kSamplesPerPass = 8 * kGroups;         ///< of each half
constexpr std::uint64_t kLeastSamplesPerHalf = 512;  ///< below it, rare bright paths may be in no estimate
constexpr double kSecondsBetweenCheckpoints = 10;

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::uint32_t seedOfHalf(std::uint32_t seed, int half) {
  constexpr std::uint32_t kPoints = 0x5EFE'0001u;
  return core::hashKey(seed, kPoints, static_cast<std::uint32_t>(half), 0);
}

/// One reference while it is made.
class Computation {
 public:
  Computation(const app::Workspace& workspace, const PointTask& task, const PointConfidence& confidence,
              int threads, const core::Progress& progress, core::Warnings& warnings)
      : workspace_(workspace),
        task_(task),
        confidence_(confidence),
        threads_(threads),
        progress_(progress),
        warnings_(warnings),
        points_(raytrace::surfacePoints(*workspace.world, static_cast<std::size_t>(task.points), task.seed)),
        key_(pointReferenceKey(workspace.scene, task)),
        sums_(static_cast<int>(points_.size()), 1) {
    takeUp();
  }

  PointReference run() {
    const std::uint64_t before = sums_.samplesPerHalf;
    Clock::time_point saved = Clock::now();
    try {
      while (!points_.empty() && !done()) {
        addPass(before);
        if (secondsSince(saved) < kSecondsBetweenCheckpoints) continue;
        save();
        saved = Clock::now();
      }
    } catch (const core::Error&) {
      save();  // what was done before the stop
      throw;
    }
    if (sums_.samplesPerHalf > before) save();
    return {
        key_, points_, truth(), noise_, sums_.samplesPerPixel(), sums_.seconds, points_.empty() || reached()};
  }

 private:
  bool reached() const { return sums_.samplesPerHalf >= kLeastSamplesPerHalf && noise_ <= confidence_.noise; }
  bool done() const {
    return reached() || (sums_.samplesPerHalf > 0 && sums_.seconds >= confidence_.capSeconds);
  }

  void takeUp() {
    try {
      file_ = referenceFile(key_);
      if (!std::filesystem::exists(file_)) return;
      sums_ = readSums(file_, key_, sums_.width, sums_.height);
      noise_ = noiseOf(truth());
    } catch (const core::Error& e) {
      warnings_.push_back(std::string(e.what()) + "; computing it anew");
    }
  }

  /// Both halves, or neither when it throws.
  void addPass(std::uint64_t before) {
    const double start = processorSeconds();
    std::array<core::ImageRgb, 2> means;
    for (int half = 0; half < 2; ++half) means[static_cast<std::size_t>(half)] = pass(half, before);
    for (int half = 0; half < 2; ++half)
      sums_.add(half, means[static_cast<std::size_t>(half)], kSamplesPerPass);
    sums_.samplesPerHalf += kSamplesPerPass;
    sums_.seconds += (processorSeconds() - start) / std::max(1, threads_);
    noise_ = noiseOf(truth());
  }

  core::ImageRgb pass(int half, std::uint64_t before) const {
    raytrace::PathOptions options;
    options.samplesPerPixel = kSamplesPerPass;
    options.firstSample = sums_.samplesPerHalf / kGroups;
    options.bounces = task_.bounces;
    options.seed = seedOfHalf(task_.seed, half);
    core::ImageRgb mean(sums_.width, 1);
    const core::Progress inner{[&](double f) { report(before, (half + f) / 2); }, progress_.stop};
    raytrace::parallelRows(sums_.width, threads_, inner, [&](int i, int) {
      raytrace::RayCounters counters;
      mean.at(i, 0) = raytrace::pathIrradiance(*workspace_.world, points_[static_cast<std::size_t>(i)],
                                               static_cast<std::uint32_t>(i), options, counters)
                          .mean;
    });
    return mean;
  }

  /// `inPass`: the part of this pass that is done.
  void report(std::uint64_t before, double inPass) const {
    if (!progress_.report || !(sums_.seconds > 0)) return;
    const auto now = static_cast<double>(sums_.samplesPerHalf);
    const double ratio = noise_ / confidence_.noise;
    const double byNoise = std::max(now * ratio * ratio, static_cast<double>(kLeastSamplesPerHalf));
    const double end = std::min(byNoise, now * confidence_.capSeconds / sums_.seconds);
    const double ahead = end - static_cast<double>(before);
    const double made = now + inPass * kSamplesPerPass - static_cast<double>(before);
    progress_.report(ahead > 0 ? std::min(1.0, made / ahead) : 1);
  }

  /// A cache that cannot be written costs time the next time, nothing else.
  void save() {
    if (file_.empty() || sums_.samplesPerHalf == 0) return;
    try {
      std::error_code ignored;  // writing says what went wrong
      std::filesystem::create_directories(file_.parent_path(), ignored);
      writeSums(file_, key_, sums_);
    } catch (const core::Error& e) {
      warnings_.push_back(std::string(e.what()) + "; the reference is not kept (set XDG_CACHE_HOME)");
      file_.clear();
    }
  }

  std::vector<PointTruth> truth() const {
    std::vector<PointTruth> out;
    if (sums_.samplesPerHalf == 0) return out;
    const core::ImageRgb mean = sums_.mean(), a = sums_.half(0), b = sums_.half(1);
    for (int i = 0; i < sums_.width; ++i) {
      const double half = (double{core::luminance(a.at(i, 0))} - double{core::luminance(b.at(i, 0))}) / 2;
      out.push_back({mean.at(i, 0), half * half});
    }
    return out;
  }

  const app::Workspace& workspace_;
  const PointTask& task_;
  const PointConfidence& confidence_;
  int threads_;
  const core::Progress& progress_;
  core::Warnings& warnings_;
  std::vector<raytrace::SurfacePoint> points_;
  std::uint64_t key_;
  std::filesystem::path file_;  ///< empty: nothing is kept
  ReferenceSums sums_;
  double noise_ = 0;  ///< of sums_
};

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
  return Computation(uncharted, task, confidence, threads, progress, warnings).run();
}

PointReference pointReferenceOf(const app::Workspace& uncharted, const PointTask& task,
                                const PointConfidence& confidence, const std::stop_token& stop) {
  core::Warnings warnings;
  const PointReference reference = [&] {
    app::ProgressBar bar("reference");
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return computePointReference(uncharted, task, confidence, threads,
                                 {[&](double fraction) { bar.show(fraction); }, stop}, warnings);
  }();
  if (!reference.reached) {
    char line[200];
    std::snprintf(line, sizeof line,
                  "reference: noise %.2g %% of the mean after %.0f s, not the %.2g %% asked for; it is taken "
                  "out of the errors, which scatter the more",
                  100 * reference.noise, reference.seconds, 100 * confidence.noise);
    warnings.emplace_back(line);
  }
  app::printWarnings(warnings);
  return reference;
}

}  // namespace saccade::bench
