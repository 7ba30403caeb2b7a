// The long stages of a bake.
#include <cmath>
#include <utility>

#include "raytrace/bake/baker.h"
#include "raytrace/lights.h"

namespace saccade::raytrace {
namespace {

constexpr float kDirectError = 0.08f;  // standard error times the root of the samples, for refinement
// Shares of a bake's time, measured in the bundled scenes; only the guess until a stage's own pace is known.
constexpr double kOpenWeight = 0.03, kParticleWeight = 0.2, kDirectWeight = 0.3, kGatherWeight = 0.45,
                 kProbeWeight = 0.1, kDetailWeight = 0.2;

/// As bytes, for checkpoints.
template <class T>
std::span<std::byte> bytesOf(std::span<T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return std::as_writable_bytes(values);
}

}  // namespace

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
  direct.samples = quality_.directSamples;
  direct.relativeError = kDirectError / std::sqrt(static_cast<float>(direct.samples));
  direct.wholePoints = quality_.wholePoints;
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
  gather.rays = quality_.gatherRays;
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
  layers.reserve(static_cast<std::size_t>(layers_));
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

}  // namespace saccade::raytrace
