#include "raytrace/bake/baker.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"

namespace saccade::raytrace {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t kPaceShare = 50;  // a 50th of a stage is done first, to learn its pace
/// Of a bake's time (see the stages' weights).
constexpr double kFinishWeight = 0.02;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

BakeJob::BakeJob(const World& world, int atlasSize, const BakeOptions& options)
    : world_(world),
      options_(options),
      quality_(qualityOf(options.quality)),
      texels_(world.scene(), atlasSize),
      layers_(texels_.anyDoubleSided() ? 2 : 1),
      open_(texels_, layers_),
      particles_(world, texels_.texelCount(), layers_),
      direct_(static_cast<std::size_t>(layers_), std::vector<DirectEstimate>(texels_.texelCount())),
      detail_(world, texels_, open_, layers_, {quality_.detailError, options.detailTexels}) {
  if (options_.photons == 0) options_.photons = quality_.photons;
  const auto share = static_cast<std::uint64_t>(quality_.causticShare);
  tracing_.caustic = options_.photons / 256 * share + options_.photons % 256 * share / 256;
  tracing_.whole = options_.photons - tracing_.caustic;
  tracing_.seed = options_.seed;
  tracing_.threads = options_.threads;
  if (!particles_.caustics) tracing_.caustic = 0;
  if (quality_.gatherRays > 0) gathered_ = direct_;
  for (int layer = 0; layer < layers_; ++layer) addOpenArea(layer);
  addParticles();
  for (int layer = 0; layer < layers_; ++layer) addDirect(layer);
  if (options_.detailTexels > 0) {
    addEdgeProbes();
    addDetail();
  }
  for (int layer = 0; layer < layers_ && quality_.gatherRays > 0; ++layer) addGather(layer);
}

bool BakeJob::advance(const std::stop_token& pause, const BakeReport& report) {
  for (BakeStage& stage : stages_)
    if (stage.independent && !run(stage, stage.units / kPaceShare, pause, report)) return false;
  for (BakeStage& stage : stages_)
    if (!run(stage, stage.units, pause, report)) return false;
  return true;
}

std::uint64_t BakeJob::settingsHash() const {
  core::ContentHash hash;
  hash.add(options_.quality);
  // Another build may stand for something else by the same name.
  for (const int n :
       {quality_.causticShare, quality_.directSamples, quality_.wholePoints, quality_.gatherRays})
    hash.add(n);
  hash.add(quality_.detailError);
  hash.add(options_.photons);
  hash.add(options_.seed);
  hash.add(static_cast<std::uint64_t>(options_.detailTexels));
  hash.add(texels_.size());
  for (const core::Mesh& mesh : world_.scene().meshes) {
    hash.add(mesh.vertexLit);
    for (const std::uint32_t i : mesh.indices) {
      hash.add(mesh.lightmapUv[i].x);
      hash.add(mesh.lightmapUv[i].y);
    }
  }
  for (const core::Object& object : world_.scene().objects) {
    for (int c = 0; c < 4; ++c) hash.add(object.lightmapScaleOffset[c]);
  }
  if (options_.kept) {
    hash.add(options_.kept->previous->key);
    for (const char keep : options_.kept->keep) hash.add(keep);
  }
  return hash.value();
}

BakeProgress BakeJob::progress() { return progressAt({}, ""); }

bool BakeJob::run(BakeStage& stage, std::uint64_t last, const std::stop_token& pause,
                  const BakeReport& report) {
  if (stage.done >= last) return true;
  const Clock::time_point start = Clock::now();
  core::Progress slice{{}, pause};
  if (report) {
    slice.report = [&](double fraction) {
      Pace now{&stage, stage.done, stage.seconds + secondsSince(start)};
      now.done += static_cast<std::uint64_t>(fraction * static_cast<double>(last - stage.done));
      report(progressAt(now, stage.name));
    };
  }
  stage.done = stage.work(stage.done, last, slice);
  stage.seconds += secondsSince(start);
  return stage.done == last && !pause.stop_requested();
}

BakeProgress BakeJob::progressAt(const Pace& now, std::string_view stage) {
  // Seconds spent and left where a stage's pace is known; the others by their weights beside those.
  double spent = 0, left = 0, knownWeight = 0, unknownWeight = kFinishWeight * (1 - now.finished);
  for (const BakeStage& s : stages_) {
    const std::uint64_t done = &s == now.stage ? now.done : s.done;
    const double seconds = &s == now.stage ? now.seconds : s.seconds;
    spent += seconds;
    if (s.units == 0) continue;
    if (done == 0) {
      unknownWeight += s.weight;
      continue;
    }
    left += seconds * static_cast<double>(s.units - done) / static_cast<double>(done);
    knownWeight += s.weight;
  }
  if (knownWeight > 0) {
    const double perWeight = (spent + left) / knownWeight;
    left += perWeight * unknownWeight;
    spent += perWeight * kFinishWeight * now.finished;
  }
  if (now.finished >= 1) left = 0;
  if (spent + left > 0) fraction_ = std::max(fraction_, spent / (spent + left));
  return {now.finished >= 1 ? 1.0 : fraction_, left, stage};
}

core::IlluminationMaps bakeMaps(const World& world, core::SceneCharts charts, int atlasSize,
                                const BakeOptions& options, const core::Progress& progress) {
  BakeJob job(world, atlasSize, options);
  BakeReport report;
  if (progress.report) report = [&](const BakeProgress& p) { progress.report(p.fraction); };
  if (!job.advance(progress.stop, report)) throw core::Error("stopped on request");
  return job.finish(std::move(charts), progress.stop, report);
}

}  // namespace saccade::raytrace
