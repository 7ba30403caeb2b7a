// The quick end of a bake, and the light that gather rays look up, which is found the same way.
#include <utility>

#include "raytrace/bake/baker.h"
#include "raytrace/bake/density.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/map_half.h"
#include "raytrace/bake/seams.h"

namespace saccade::raytrace {
namespace {

// Direct light has small errors and sharp edges: it is smoothed where its samples leave no doubt, and little.
constexpr float kDirectConfidence = 0.4f;
constexpr double kDirectEnough = 40000;  // 0.5 % noise
constexpr int kDirectMaxRadius = 3;      // texels
// Gathered light is smooth, its rays are few and now and then meet something bright.
constexpr int kGatherMaxRadius = 11;    // texels
constexpr int kGatherPooledRadius = 4;  // texels

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

}  // namespace

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
      quality_.gatherRays == 0
          ? indirectLight(layer, part(progress, 0.6, 1))
          : smooth(texels_, open_.areas(layer), gathered_[index],
                   smoothingOfGathered(quality_.gatherConfidence), options_.threads, part(progress, 0.6, 1));
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

}  // namespace saccade::raytrace
