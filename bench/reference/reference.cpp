#include "bench/reference/reference.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "app/cli/console.h"
#include "bench/harness/trials.h"
#include "bench/reference/sums.h"
#include "core/atomic_file.h"
#include "core/cache_folder.h"
#include "core/content_hash.h"
#include "core/image_io.h"
#include "core/maps.h"
#include "core/math/random.h"

namespace saccade::bench {
namespace {

/// A power of two: passes are then whole blocks of the pixel's (0, 2)-sequence.
constexpr int kSamplesPerPass = 8;
/// Below it the estimate may not have seen a single rare bright path.
constexpr std::uint64_t kLeastSamplesPerPixel = 64;
constexpr double kSecondsBetweenCheckpoints = 10;

/// Of all threads of this process.
double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Seeds that no method under test uses, far apart for the two halves.
std::uint32_t seedOfHalf(std::uint32_t seed, int half) {
  constexpr std::uint32_t kReferences = 0x5EFE0000u;
  return core::hashKey(seed, kReferences, static_cast<std::uint32_t>(half), 0);
}

/// One reference while it is made.
class Computation {
 public:
  Computation(const app::Workspace& workspace, const ReferenceView& view, const Confidence& confidence,
              int threads, const core::Progress& progress, core::Warnings& warnings)
      : workspace_(workspace),
        request_(view),
        view_(view.camera, view.size.width, view.size.height, workspace.scene.bounds),
        confidence_(confidence),
        threads_(threads),
        progress_(progress),
        warnings_(warnings),
        key_(referenceKey(workspace.scene, view)),
        sums_(view.size.width, view.size.height) {
    takeUp();
  }

  Reference run() {
    const bool kept = done();
    const double before = samples();
    Clock::time_point saved = Clock::now();
    try {
      while (!done()) {
        addPass(before);
        if (secondsSince(saved) < kSecondsBetweenCheckpoints) continue;
        save();
        saved = Clock::now();
      }
    } catch (const core::Error&) {
      save();  // what was done before the stop
      throw;
    }
    Reference reference = result();
    if (!kept) {
      save();
      publish(reference);
    }
    return reference;
  }

 private:
  double samples() const { return static_cast<double>(sums_.samplesPerPixel()); }
  bool reached() const {
    return sums_.samplesPerPixel() >= kLeastSamplesPerPixel && relmse_ <= confidence_.relmse;
  }
  bool done() const {
    return reached() || (sums_.samplesPerHalf > 0 && sums_.seconds >= confidence_.capSeconds);
  }

  void takeUp() {
    try {
      file_ = referenceFile(key_);
      if (!std::filesystem::exists(file_)) return;
      sums_ = readSums(file_, key_, view_.width(), view_.height());
      relmse_ = sums_.relmse();
    } catch (const core::Error& e) {
      warnings_.push_back(std::string(e.what()) + "; computing it anew");
    }
  }

  /// Both halves, or neither when it throws.
  void addPass(double before) {
    const double start = processorSeconds();
    std::array<core::ImageRgb, 2> means;
    for (int half = 0; half < 2; ++half) {
      const core::Progress inner{[&](double f) { report(before, (half + f) * kSamplesPerPass); },
                                 progress_.stop};
      means[half] = raytrace::tracePaths(*workspace_.world, view_, optionsOf(half), inner).radiance;
    }
    for (int half = 0; half < 2; ++half) sums_.add(half, means[half], kSamplesPerPass);
    sums_.samplesPerHalf += kSamplesPerPass;
    sums_.seconds += (processorSeconds() - start) / std::max(1, threads_);
    relmse_ = sums_.relmse();
  }

  raytrace::PathOptions optionsOf(int half) const {
    raytrace::PathOptions options;
    options.samplesPerPixel = kSamplesPerPass;
    options.firstSample = sums_.samplesPerHalf;
    options.bounces = request_.bounces;
    options.transport = request_.transport;
    options.diffuse = request_.diffuse;
    options.seed = seedOfHalf(request_.seed, half);
    options.threads = threads_;
    return options;
  }

  /// The error falls as one over the samples; `inPass` samples a pixel of the present pass are done.
  void report(double before, double inPass) const {
    if (!progress_.report || !(sums_.seconds > 0)) return;
    const double byError = std::max(static_cast<double>(kLeastSamplesPerPixel),
                                    samples() * relmse_ / std::max(confidence_.relmse, 1e-300));
    const double byTime = samples() * confidence_.capSeconds / sums_.seconds;
    const double ahead = std::min(byError, byTime) - before;
    progress_.report(ahead > 0 ? std::min(1.0, (samples() + inPass - before) / ahead) : 1);
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

  Reference result() const {
    Reference reference;
    reference.key = key_;
    reference.radiance = sums_.mean();
    reference.own = core::compareLinear(reference.radiance, sums_.half(0));
    reference.samplesPerPixel = sums_.samplesPerPixel();
    reference.seconds = sums_.seconds;
    reference.reached = reached();
    return reference;
  }

  void publish(const Reference& reference) {
    if (file_.empty()) return;
    try {
      core::writeExr(std::filesystem::path(file_).replace_extension(".exr"), reference.radiance);
      const std::string text = description(reference).dump(1) + "\n";
      core::writeFileAtomically(std::filesystem::path(file_).replace_extension(".json"),
                                std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    } catch (const core::Error& e) {
      warnings_.push_back(std::string(e.what()) +
                          "; the reference's picture is not kept (set XDG_CACHE_HOME)");
    }
  }

  nlohmann::ordered_json description(const Reference& reference) const {
    const auto list = [](const core::Vec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
    const core::Camera& camera = request_.camera;
    return {{"schema", 1},
            {"key", core::cacheName(key_)},
            {"scene", workspace_.scene.path},
            {"eye", list(camera.eye)},
            {"at", list(camera.at)},
            {"up", list(camera.up)},
            {"fov", camera.fovYDegrees},
            {"width", request_.size.width},
            {"height", request_.size.height},
            {"lobes", request_.transport == raytrace::Transport::all ? "all" : "diffuse"},
            {"diffuse", request_.diffuse == raytrace::DiffuseModel::lambert ? "lambert" : "burley"},
            {"bounces", request_.bounces},
            {"seed", request_.seed},
            {"path_tracer_version", raytrace::kPathTracerVersion},
            {"samples_per_pixel", reference.samplesPerPixel},
            {"seconds", reference.seconds},
            {"asked_relmse", confidence_.relmse},
            {"reached", reference.reached},
            {"relmse", reference.own.relmse},
            {"rmse", reference.own.rmse},
            {"flip", reference.own.flip}};
  }

  const app::Workspace& workspace_;
  const ReferenceView& request_;
  core::View view_;
  const Confidence& confidence_;
  int threads_;
  const core::Progress& progress_;
  core::Warnings& warnings_;
  std::uint64_t key_;
  std::filesystem::path file_;  ///< empty: nothing is kept
  ReferenceSums sums_;
  double relmse_ = 0;  ///< of sums_
};

}  // namespace

std::uint64_t referenceKey(const core::Scene& scene, const ReferenceView& view) {
  core::ContentHash hash;
  hash.add(raytrace::kPathTracerVersion);
  hash.add(kSamplesPerPass);
  hash.add(core::sceneKey(scene));
  for (const core::Vec3& v : {view.camera.eye, view.camera.at, view.camera.up}) {
    for (int c = 0; c < 3; ++c) hash.add(v[c]);
  }
  hash.add(view.camera.fovYDegrees);
  hash.add(view.size.width);
  hash.add(view.size.height);
  hash.add(view.transport);
  hash.add(view.diffuse);
  hash.add(view.bounces);
  hash.add(view.seed);
  return hash.value();
}

std::filesystem::path referenceFile(std::uint64_t key) {
  return core::cacheFolder() / "references" / (core::cacheName(key) + ".sums");
}

Reference computeReference(const app::Workspace& workspace, const ReferenceView& view,
                           const Confidence& confidence, int threads, const core::Progress& progress,
                           core::Warnings& warnings) {
  return Computation(workspace, view, confidence, threads, progress, warnings).run();
}

Reference referenceOf(const app::Workspace& workspace, const ReferenceView& view,
                      const Confidence& confidence, const std::stop_token& stop) {
  core::Warnings warnings;
  const Reference reference = [&] {
    app::ProgressBar bar("reference");
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return computeReference(workspace, view, confidence, threads,
                            {[&](double fraction) { bar.show(fraction); }, stop}, warnings);
  }();
  if (!reference.reached) {
    char line[200];
    std::snprintf(line, sizeof line,
                  "reference: relative MSE %.2g after %.0f s, not the %.2g asked for; differences below it "
                  "mean nothing",
                  reference.own.relmse, reference.seconds, confidence.relmse);
    warnings.emplace_back(line);
  }
  app::printWarnings(warnings);
  return reference;
}

}  // namespace saccade::bench
