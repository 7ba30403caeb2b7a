#include "bench/reference/reference.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "bench/reference/kept_sums.h"
#include "core/atomic_file.h"
#include "core/cache_folder.h"
#include "core/content_hash.h"
#include "core/image_io.h"
#include "core/maps.h"

namespace saccade::bench {
namespace {

/// A power of two: passes are then whole blocks of the pixel's (0, 2)-sequence.
constexpr int kSamplesPerPass = 8;
/// Below it the estimate may not have seen a single rare bright path.
constexpr std::uint64_t kLeastSamplesPerPixel = 64;

raytrace::PathOptions passOptions(const ReferenceView& view, int half, std::uint64_t done, int threads) {
  raytrace::PathOptions options;
  options.samplesPerPixel = kSamplesPerPass;
  options.firstSample = done;
  options.bounces = view.bounces;
  options.transport = view.transport;
  options.diffuse = view.diffuse;
  options.seed = seedOfHalf(ReferenceKind::picture, view.seed, half);
  options.threads = threads;
  return options;
}

nlohmann::ordered_json description(const Reference& reference, const std::string& scene,
                                   const ReferenceView& view, const Confidence& asked) {
  const auto list = [](const core::Vec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  return {{"schema", 1},
          {"key", core::cacheName(reference.key)},
          {"scene", scene},
          {"eye", list(view.camera.eye)},
          {"at", list(view.camera.at)},
          {"up", list(view.camera.up)},
          {"fov", view.camera.fovYDegrees},
          {"width", view.size.width},
          {"height", view.size.height},
          {"lobes", view.transport == raytrace::Transport::all ? "all" : "diffuse"},
          {"diffuse", view.diffuse == raytrace::DiffuseModel::lambert ? "lambert" : "burley"},
          {"bounces", view.bounces},
          {"seed", view.seed},
          {"path_tracer_version", raytrace::kPathTracerVersion},
          {"samples_per_pixel", reference.samplesPerPixel},
          {"seconds", reference.seconds},
          {"asked_relmse", asked.relmse},
          {"reached", reference.reached},
          {"relmse", reference.own.relmse},
          {"rmse", reference.own.rmse},
          {"flip", reference.own.flip}};
}

/// Picture and description beside the sums.
void publish(const std::filesystem::path& sums, const Reference& reference,
             const nlohmann::ordered_json& about, core::Warnings& warnings) {
  try {
    core::writeExr(std::filesystem::path(sums).replace_extension(".exr"), reference.radiance);
    const std::string text = about.dump(1) + "\n";
    core::writeFileAtomically(std::filesystem::path(sums).replace_extension(".json"),
                              std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  } catch (const core::Error& e) {
    warnings.push_back(std::string(e.what()) + "; the reference's picture is not kept (set XDG_CACHE_HOME)");
  }
}

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

Reference computeReference(const app::Workspace& workspace, const ReferenceView& view,
                           const Confidence& confidence, int threads, const core::Progress& progress,
                           core::Warnings& warnings) {
  const core::View picture(view.camera, view.size.width, view.size.height, workspace.scene.bounds);
  SumsTask task;
  task.key = referenceKey(workspace.scene, view);
  task.width = view.size.width;
  task.height = view.size.height;
  task.samplesPerPass = kSamplesPerPass;
  task.leastSamplesPerHalf = kLeastSamplesPerPixel / 2;
  task.pass = [&](int half, std::uint64_t done, const core::Progress& inner) {
    return raytrace::tracePaths(*workspace.world, picture, passOptions(view, half, done, threads), inner)
        .radiance;
  };
  task.error = [](const ReferenceSums& sums) { return sums.relmse(); };
  task.wantedError = confidence.relmse;
  task.capSeconds = confidence.capSeconds;
  task.threads = threads;
  const KeptSums kept = keepSums(task, progress, warnings);
  Reference reference;
  reference.key = task.key;
  reference.radiance = kept.sums.mean();
  reference.own = core::compareLinear(reference.radiance, kept.sums.half(0));
  reference.samplesPerPixel = kept.sums.samplesPerPixel();
  reference.seconds = kept.sums.seconds;
  reference.reached = kept.reached;
  if (kept.grew && !kept.file.empty())
    publish(kept.file, reference, description(reference, workspace.scene.path, view, confidence), warnings);
  return reference;
}

Reference referenceOf(const app::Workspace& workspace, const ReferenceView& view,
                      const Confidence& confidence, const std::stop_token& stop) {
  Reference reference;
  computeReported(stop, [&](int threads, const core::Progress& progress, core::Warnings& warnings) {
    reference = computeReference(workspace, view, confidence, threads, progress, warnings);
    if (reference.reached) return;
    char line[200];
    std::snprintf(line, sizeof line,
                  "reference: relative MSE %.2g after %.0f s, not the %.2g asked for; differences below it "
                  "mean nothing",
                  reference.own.relmse, reference.seconds, confidence.relmse);
    warnings.emplace_back(line);
  });
  return reference;
}

}  // namespace saccade::bench
