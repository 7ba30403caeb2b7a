#include "raytrace/bake/baker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "raytrace/bake/density.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/map_half.h"
#include "raytrace/bake/seams.h"
#include "raytrace/lights.h"

namespace saccade::raytrace {
namespace {

// Direct light has small errors and sharp edges: it is smoothed where its samples leave no doubt, and little.
constexpr float kDirectError = 0.08f;  // standard error times the root of the samples, for refinement
constexpr float kDirectConfidence = 0.4f;
constexpr double kDirectEnough = 40000;  // 0.5 % noise
constexpr int kDirectMaxRadius = 3;      // texels
// Gathered light is smooth, its rays are few and now and then meet something bright.
constexpr int kGatherMaxRadius = 11;    // texels
constexpr int kGatherPooledRadius = 4;  // texels

struct Preset {
  const char* name;
  std::uint64_t photons;  ///< of all kinds
  int causticShare;       ///< of 256 photons, those that are followed to the first diffuse surface only
  int directSamples;
  int gatherRays;
  /// Of the smoothing of gathered light: the more evenly rays lie, the more their spread overstates the
  /// error.
  float gatherConfidence;
  double detailError;  ///< of direct light, that finer texels at shadows' edges are to keep
};
// High is what keeps the errors of known scenes (bake_truth_test.cpp) below half a percent.
constexpr Preset kPresets[] = {{"preview", 1 << 18, 0, 4, 0, 0, 0.05},
                               {"medium", 1 << 22, 240, 16, 32, 1.5f, 0.02},
                               {"high", 1 << 23, 240, 64, 128, 0.7f, 0.008}};

using Clock = std::chrono::steady_clock;
// Shares of a bake's time, measured in the bundled scenes; only the guess until a stage's own pace is known.
constexpr double kOpenWeight = 0.03, kParticleWeight = 0.2, kDirectWeight = 0.3, kGatherWeight = 0.45,
                 kProbeWeight = 0.1, kDetailWeight = 0.2, kFinishWeight = 0.02;
constexpr std::uint64_t kPaceShare = 50;  // a 50th of a stage is done first, to learn its pace

const Preset& presetOf(const std::string& quality) {
  for (const Preset& p : kPresets) {
    if (quality == p.name) return p;
  }
  throw core::UsageError("unknown quality '" + quality + "': use preview, medium or high");
}

/// Appends one layer's texels, and counts what halves cannot hold.
void storeHalves(const TexelMap& texels, const std::vector<Vec3>& irradiance, core::IlluminationMaps& maps) {
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    const Vec3 e = irradiance[i];
    for (int c = 0; c < 3; ++c) maps.texels.push_back(mapHalf(e[c]));
    const Vec3 over = glm::max(e - kLargestHalf, Vec3(0));
    if (texels.area(i) == 0 || over == Vec3(0)) continue;  // gutters repeat others
    ++maps.clampedTexels;
    maps.clampedWatts += (double{over.x} + over.y + over.z) / 3 * texels.area(i);
  }
}

DensityOptions smoothingOfDirect() {
  DensityOptions smoothing;
  smoothing.confidence = kDirectConfidence;
  smoothing.enough = kDirectEnough;
  smoothing.doubt = 0;
  smoothing.maxRadius = kDirectMaxRadius;
  return smoothing;
}

DensityOptions smoothingOfGathered(float confidence) {
  DensityOptions smoothing;
  smoothing.confidence = confidence;
  smoothing.doubt = 0;
  smoothing.maxRadius = kGatherMaxRadius;
  smoothing.pooledRadius = kGatherPooledRadius;
  return smoothing;
}

/// Of one layer.
std::vector<DensityEstimate> smooth(const TexelMap& texels, std::span<const float> areas,
                                    const std::vector<DirectEstimate>& estimates, DensityOptions smoothing,
                                    int threads, const core::Progress& progress) {
  double watts = 0;
  const FluxGrid flux = fluxOf(areas, estimates, watts);
  smoothing.threads = threads;
  std::vector<DensityEstimate> out(texels.texelCount());
  estimateDensity(texels, areas, flux, 0, watts, smoothing, progress, {}, out);
  return out;
}

/// The part [from, to] of a progress bar.
core::Progress part(const core::Progress& whole, double from, double to) {
  core::Progress p{{}, whole.stop};
  if (whole.report) p.report = [&whole, from, to](double f) { whole.report(from + (to - from) * f); };
  return p;
}

/// As bytes, for checkpoints.
template <class T>
std::span<std::byte> bytesOf(std::span<T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return std::as_writable_bytes(values);
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::uint64_t photonsOf(const std::string& quality) { return presetOf(quality).photons; }

/// How far a stage has come at the moment of a report.
struct BakeJob::Pace {
  const BakeStage* stage = nullptr;  ///< null: the quick end
  std::uint64_t done = 0;
  double seconds = 0;
  double finished = 0;  ///< share of the quick end
};

BakeJob::BakeJob(const World& world, int atlasSize, const BakeOptions& options)
    : world_(world),
      options_(options),
      texels_(world.scene(), atlasSize),
      layers_(texels_.anyDoubleSided() ? 2 : 1),
      open_(texels_, layers_),
      gatherRays_(presetOf(options.quality).gatherRays),
      particles_(world, texels_.texelCount(), layers_),
      direct_(static_cast<std::size_t>(layers_), std::vector<DirectEstimate>(texels_.texelCount())),
      detail_(world, texels_, open_, layers_, {presetOf(options.quality).detailError, options.detailTexels}) {
  const Preset& preset = presetOf(options.quality);
  if (options_.photons == 0) options_.photons = preset.photons;
  const auto share = static_cast<std::uint64_t>(preset.causticShare);
  tracing_.caustic = options_.photons / 256 * share + options_.photons % 256 * share / 256;
  tracing_.whole = options_.photons - tracing_.caustic;
  tracing_.seed = options_.seed;
  tracing_.threads = options_.threads;
  if (!particles_.caustics) tracing_.caustic = 0;
  if (gatherRays_ > 0) gathered_ = direct_;
  for (int layer = 0; layer < layers_; ++layer) addOpenArea(layer);
  addParticles();
  for (int layer = 0; layer < layers_; ++layer) addDirect(layer);
  if (options_.detailTexels > 0) {
    addEdgeProbes();
    addDetail();
  }
  for (int layer = 0; layer < layers_ && gatherRays_ > 0; ++layer) addGather(layer);
}

void BakeJob::addOpenArea(int layer) {
  BakeStage stage;
  stage.name = layer == 0 ? "open surface" : "open backs";
  stage.units = allBlocks(texels_.texelCount()).last;
  stage.weight = kOpenWeight / layers_;
  stage.results = bytesOf(open_.areas(layer));
  stage.work = [this, layer](std::uint64_t first, std::uint64_t last,
                             const core::Progress& progress) -> std::uint64_t {
    return open_.probe(world_, texels_, layer, {first, last}, options_.threads, progress);
  };
  stages_.push_back(std::move(stage));
}

void BakeJob::addParticles() {
  BakeStage stage;
  stage.name = "particles";
  stage.units = world_.lights().empty() || !(world_.lights().totalPower() > 0) ? 0 : tracing_.total();
  stage.weight = kParticleWeight;
  stage.results = bytesOf(particles_.flux.cells());
  stage.work = [this](std::uint64_t first, std::uint64_t last, const core::Progress& progress) {
    particles_.emitted = first;
    traceParticles(world_, texels_, tracing_, last, progress, particles_);
    return particles_.emitted;
  };
  stages_.push_back(std::move(stage));
}

DirectOptions BakeJob::directOptions() const {
  DirectOptions direct;
  direct.samples = presetOf(options_.quality).directSamples;
  direct.relativeError = kDirectError / std::sqrt(static_cast<float>(direct.samples));
  if (options_.quality != "high") direct.wholePoints = direct.samples;
  direct.seed = options_.seed;
  direct.threads = options_.threads;
  if (options_.kept) direct.keptCharts = &options_.kept->keep;
  return direct;
}

void BakeJob::addDirect(int layer) {
  const DirectOptions direct = directOptions();
  BakeStage stage;
  stage.name = layer == 0 ? "direct light" : "direct light on backs";
  stage.units = allBlocks(texels_.texelCount()).last;
  stage.weight = kDirectWeight / layers_;
  const std::span<DirectEstimate> out(direct_[static_cast<std::size_t>(layer)]);
  stage.results = bytesOf(out);
  stage.work = [this, layer, direct, out](std::uint64_t first, std::uint64_t last,
                                          const core::Progress& progress) -> std::uint64_t {
    return directIrradiance(world_, texels_, open_, layer, {first, last}, direct, progress, out);
  };
  stages_.push_back(std::move(stage));
}

void BakeJob::addGather(int layer) {
  GatherOptions gather;
  gather.rays = gatherRays_;
  gather.seed = options_.seed;
  gather.threads = options_.threads;
  if (options_.kept) gather.keptCharts = &options_.kept->keep;
  BakeStage stage;
  stage.name = layer == 0 ? "final gathering" : "final gathering on backs";
  stage.units = world_.lights().empty() ? 0 : allBlocks(texels_.texelCount()).last;
  stage.weight = kGatherWeight / layers_;
  stage.independent = false;
  const std::span<DirectEstimate> out(gathered_[static_cast<std::size_t>(layer)]);
  stage.results = bytesOf(out);
  stage.work = [this, layer, gather, out](std::uint64_t first, std::uint64_t last,
                                          const core::Progress& progress) -> std::uint64_t {
    if (source_.layers[0].empty()) findSource({});
    return gatherIrradiance(world_, texels_, open_, layer, {first, last}, source_, gather, progress, out);
  };
  stages_.push_back(std::move(stage));
}

std::vector<LayerLight> BakeJob::directLayers() {
  std::vector<LayerLight> layers;
  for (int layer = 0; layer < layers_; ++layer)
    layers.push_back({direct_[static_cast<std::size_t>(layer)], open_.areas(layer),
                      options_.kept ? &options_.kept->keep : nullptr});
  return layers;
}

void BakeJob::addEdgeProbes() {
  BakeStage stage;
  stage.name = "finding edges";
  stage.units = world_.lights().empty() ? 0 : allBlocks(texels_.texelCount()).last;
  stage.weight = kProbeWeight;
  stage.independent = false;
  stage.results = bytesOf(detail_.probes());
  stage.work = [this](std::uint64_t first, std::uint64_t last,
                      const core::Progress& progress) -> std::uint64_t {
    return detail_.probe(directLayers(), directOptions(), {first, last}, progress);
  };
  stages_.push_back(std::move(stage));
}

void BakeJob::addDetail() {
  BakeStage stage;
  stage.name = "edges of light";
  stage.units = world_.lights().empty() ? 0 : DetailLight::kPieces;
  stage.weight = kDetailWeight;
  stage.independent = false;
  stage.results = bytesOf(detail_.cells());
  stage.work = [this](std::uint64_t first, std::uint64_t last,
                      const core::Progress& progress) -> std::uint64_t {
    detail_.plan(directLayers(), options_.kept);
    if (source_.layers[0].empty()) findSource({});
    return detail_.trace(first, last, source_, directOptions(), progress);
  };
  stages_.push_back(std::move(stage));
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

std::vector<DensityEstimate> BakeJob::particleLight(int layer, int plane, std::uint64_t emitted,
                                                    const core::Progress& progress) {
  DensityOptions density;
  density.threads = options_.threads;
  std::vector<DensityEstimate> out(texels_.texelCount());
  estimateDensity(texels_, open_.areas(layer), particles_.flux, plane, wattsPerWeight(world_, emitted),
                  density, progress, {}, out);
  return out;
}

std::vector<DensityEstimate> BakeJob::causticLight(int layer, const core::Progress& progress) {
  if (!particles_.caustics) return std::vector<DensityEstimate>(texels_.texelCount());
  return particleLight(layer, particles_.causticPlane(layer), tracing_.total(), progress);
}

/// As the particles alone have it.
std::vector<DensityEstimate> BakeJob::indirectLight(int layer, const core::Progress& progress) {
  return particleLight(layer, ParticleState::indirectPlane(layer), tracing_.whole, progress);
}

void BakeJob::findSource(const core::Progress& progress) {
  for (int layer = 0; layer < layers_; ++layer) {
    const std::vector<DensityEstimate> indirect = indirectLight(layer, progress),
                                       caustic = causticLight(layer, progress);
    const std::vector<DirectEstimate>& direct = direct_[static_cast<std::size_t>(layer)];
    std::vector<Vec3>& source = source_.layers[layer];
    source.resize(texels_.texelCount());
    for (std::size_t i = 0; i < source.size(); ++i)
      source[i] = direct[i].irradiance + caustic[i].irradiance + indirect[i].irradiance;
    takeKept(layer, source);
    fillGutters(texels_, source);
  }
}

void BakeJob::takeKept(int layer, std::span<Vec3> irradiance) const {
  if (!options_.kept || layer >= options_.kept->previous->layers) return;
  const auto size = static_cast<std::size_t>(texels_.size());
  for (std::size_t t = 0; t < irradiance.size(); ++t) {
    const std::int32_t chart = texels_.chartOf(t);
    if (chart < 0 || !options_.kept->keep[static_cast<std::size_t>(chart)]) continue;
    irradiance[t] =
        options_.kept->previous->texel(static_cast<int>(t % size), static_cast<int>(t / size), layer);
  }
}

BakeJob::FinishedLayer BakeJob::finishLayer(int layer, const core::Progress& progress) {
  const auto index = static_cast<std::size_t>(layer);
  const std::vector<DensityEstimate> direct =
      smooth(texels_, open_.areas(layer), direct_[index], smoothingOfDirect(), options_.threads,
             part(progress, 0, 0.3));
  const std::vector<DensityEstimate> caustic = causticLight(layer, part(progress, 0.3, 0.6));
  const std::vector<DensityEstimate> indirect =
      gatherRays_ == 0 ? indirectLight(layer, part(progress, 0.6, 1))
                       : smooth(texels_, open_.areas(layer), gathered_[index],
                                smoothingOfGathered(presetOf(options_.quality).gatherConfidence),
                                options_.threads, part(progress, 0.6, 1));
  FinishedLayer out;
  std::vector<Vec3>& irradiance = out.irradiance;
  for (std::size_t i = 0; i < texels_.texelCount(); ++i) {
    out.indirect.push_back(caustic[i].irradiance + indirect[i].irradiance);
    irradiance.push_back(direct[i].irradiance + out.indirect[i]);
  }
  fillGutters(texels_, out.indirect);
  if (options_.imported)
    importIrradiance(texels_, world_.scene(), *options_.imported, options_.threads, irradiance);
  takeKept(layer, irradiance);
  fillGutters(texels_, irradiance);
  stitchSeams(findSeams(texels_), texels_.size(), layer == 1, irradiance);
  takeKept(layer, irradiance);  // border texels that were moved to their centres once are not moved again
  return out;
}

core::IlluminationMaps BakeJob::finish(core::SceneCharts charts, const std::stop_token& stop,
                                       const BakeReport& report) {
  core::IlluminationMaps maps;
  maps.width = maps.height = texels_.size();
  maps.layers = layers_;
  maps.charts = std::move(charts);
  maps.quality = options_.quality;
  maps.photons = options_.photons;
  maps.texels.reserve(texels_.texelCount() * 3 * static_cast<std::size_t>(layers_));
  std::vector<std::vector<Vec3>> irradiance, indirect;  // by layer
  for (int layer = 0; layer < layers_; ++layer) {
    core::Progress progress{{}, stop};
    if (report) {
      progress.report = [&](double fraction) {
        report(progressAt({nullptr, 0, 0, (layer + fraction) / layers_}, "smoothing"));
      };
    }
    FinishedLayer finished = finishLayer(layer, progress);
    storeHalves(texels_, finished.irradiance, maps);
    irradiance.push_back(std::move(finished.irradiance));
    indirect.push_back(std::move(finished.indirect));
  }
  detail_.plan(directLayers(), options_.kept);
  maps.detail = detail_.finish(indirect, irradiance, options_.kept, options_.imported);
  return maps;
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
