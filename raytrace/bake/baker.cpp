#include "raytrace/bake/baker.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <utility>

#include "core/error.h"
#include "raytrace/bake/density.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/imported_light.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {
namespace {

constexpr float kLargestHalf = 65504;
// Direct light has small errors and sharp edges: it is smoothed where its samples leave no doubt, and little.
constexpr float kDirectConfidence = 0.4f;
constexpr double kDirectEnough = 40000;  // 0.5 % noise
constexpr int kDirectMaxRadius = 3;      // texels

struct Preset {
  const char* name;
  std::uint64_t photons;
  int directSamples;
};
// About 1, 10 and 60 seconds for a Cornell room on two cores.
constexpr Preset kPresets[] = {{"preview", 1 << 18, 4}, {"medium", 1 << 22, 16}, {"high", 1 << 25, 64}};

const Preset& presetOf(const std::string& quality) {
  for (const Preset& p : kPresets) {
    if (quality == p.name) return p;
  }
  throw core::UsageError("unknown quality '" + quality + "': use preview, medium or high");
}

std::uint16_t toHalf(float value) {
  return glm::packHalf1x16(std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, kLargestHalf));
}

/// Appends one layer's texels, and counts what halves cannot hold.
void storeHalves(const TexelMap& texels, const std::vector<Vec3>& irradiance, core::IlluminationMaps& maps) {
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    const Vec3 e = irradiance[i];
    for (int c = 0; c < 3; ++c) maps.texels.push_back(toHalf(e[c]));
    const Vec3 over = glm::max(e - kLargestHalf, Vec3(0));
    if (texels.area(i) == 0 || over == Vec3(0)) continue;  // gutters repeat others
    ++maps.clampedTexels;
    maps.clampedWatts += (double{over.x} + over.y + over.z) / 3 * texels.area(i);
  }
}

/// Smoothed direct light of one layer.
std::vector<DensityEstimate> bakeDirect(const World& world, const TexelMap& texels, int layer,
                                        const Preset& preset, const BakeOptions& options,
                                        const core::Progress& progress, ProgressShare share) {
  const double middle = share.from + 0.9 * (share.to - share.from);
  DirectOptions direct;
  direct.samples = preset.directSamples;
  direct.seed = options.seed;
  direct.threads = options.threads;
  std::vector<DirectEstimate> estimates(texels.texelCount());
  directIrradiance(world, texels, layer, allBlocks(texels.texelCount()), direct, progress,
                   {share.from, middle}, estimates);
  double watts = 0;
  const FluxGrid flux = fluxOf(texels, estimates, watts);
  DensityOptions smoothing;
  smoothing.confidence = kDirectConfidence;
  smoothing.enough = kDirectEnough;
  smoothing.doubt = 0;
  smoothing.maxRadius = kDirectMaxRadius;
  smoothing.threads = options.threads;
  std::vector<DensityEstimate> out(texels.texelCount());
  estimateDensity(texels, flux, 0, watts, smoothing, progress, {middle, share.to}, out);
  return out;
}

/// One layer's irradiance, without gutters.
std::vector<Vec3> bakeLayer(const World& world, const TexelMap& texels, const ParticleState& particles,
                            int layer, const Preset& preset, const BakeOptions& options,
                            const core::Progress& progress, ProgressShare share) {
  const double middle = share.from + 0.9 * (share.to - share.from);
  const std::vector<DensityEstimate> direct =
      bakeDirect(world, texels, layer, preset, options, progress, {share.from, middle});
  DensityOptions density;
  density.threads = options.threads;
  std::vector<DensityEstimate> indirect(texels.texelCount());
  estimateDensity(texels, particles.flux, layer, wattsPerWeight(world, particles.emitted), density, progress,
                  {middle, share.to}, indirect);
  std::vector<Vec3> irradiance(texels.texelCount());
  for (std::size_t i = 0; i < irradiance.size(); ++i)
    irradiance[i] = direct[i].irradiance + indirect[i].irradiance;
  return irradiance;
}

}  // namespace

std::uint64_t photonsOf(const std::string& quality) { return presetOf(quality).photons; }

core::IlluminationMaps bakeMaps(const World& world, core::SceneCharts charts, int atlasSize,
                                const BakeOptions& options, const core::Progress& progress) {
  const Preset& preset = presetOf(options.quality);
  const TexelMap texels(world.scene(), atlasSize);
  core::IlluminationMaps maps;
  maps.width = maps.height = atlasSize;
  maps.layers = texels.anyDoubleSided() ? 2 : 1;
  maps.charts = std::move(charts);
  maps.quality = options.quality;
  maps.photons = options.photons ? options.photons : preset.photons;
  maps.texels.reserve(texels.texelCount() * 3 * static_cast<std::size_t>(maps.layers));

  constexpr double kParticleShare = 0.6;  // of the time
  ParticleState particles(texels.texelCount(), maps.layers);
  traceParticles(world, texels, maps.photons, options.seed, options.threads, progress, {0, kParticleShare},
                 particles);
  for (int layer = 0; layer < maps.layers; ++layer) {
    const double step = (1 - kParticleShare) / maps.layers, from = kParticleShare + layer * step;
    std::vector<Vec3> irradiance =
        bakeLayer(world, texels, particles, layer, preset, options, progress, {from, from + step});
    if (options.imported)
      importIrradiance(texels, world.scene(), *options.imported, options.threads, irradiance);
    fillGutters(texels, irradiance);
    storeHalves(texels, irradiance, maps);
  }
  return maps;
}

}  // namespace saccade::raytrace
