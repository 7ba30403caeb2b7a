// Particle tracing for the illumination maps: Haber 2001, section 4, after its reference 39 (Volevich,
// Myszkowski, Khodulev, Kopylov: density estimation particle tracing); Shirley, Wade, Hubbard, Zareski,
// Walter, Greenberg, "Global Illumination via Density Estimation", 1995.
//
// Departure: particles carry indirect light only. What arrives straight from a light is integrated per texel
// (direct.h): direct light dominates the error of a pure particle method, has its sharpest edges (shadows),
// and stratified shadow rays reach a given error with far fewer rays than photon counts, whose error falls as
// 1 / sqrt(n). Particles keep what shadow rays cannot find: caustics, and all further bounces, which are
// shown as they are at quality preview and else by way of final gathering (gather.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// Flux that arrived at each texel, in 64-bit fixed point: integer addition is associative, so the sums are
/// the same bits for any number of threads and any order of particles, with no reduction step and no buffer
/// per thread. One unit is 2^-30 of the mean particle's power: the rounding of a deposit (relative 1e-9) is
/// far below its noise, and 2^33 mean particles fit one texel.
class FluxGrid {
 public:
  static constexpr double kUnitsPerWeight = 1 << 30;
  /// Deposits are clamped to this many mean particles, so that no path can overflow a sum.
  static constexpr float kMaxWeight = 4096;

  struct Cell {
    std::uint64_t rgb[3] = {0, 0, 0};
    std::uint64_t squared = 0;  ///< sum of squared luminance weights: the variance of the sum
  };

  FluxGrid(std::size_t texels, int planes) : texels_(texels), cells_(texels * planes) {}

  /// Any thread, concurrently. weight = flux / mean particle's flux.
  void add(std::size_t texel, int plane, const Vec3& weight);
  Cell& cell(std::size_t texel, int plane) { return cells_[plane * texels_ + texel]; }
  const Cell& cell(std::size_t texel, int plane) const { return cells_[plane * texels_ + texel]; }
  std::span<Cell> cells() { return cells_; }  ///< texels of plane 0, then of plane 1, ...

 private:
  std::size_t texels_;
  std::vector<Cell> cells_;
};

/// Whether light can reach a diffuse surface of the scene by specular events alone: some material has a lobe
/// besides Lambert's.
bool castsCaustics(const World& world);

/// All that particle tracing has found so far. Sums and the number of finished particles suffice to go on
/// later: particle i is a function of (i, seed) alone. `layers`: 0 fronts, 1 backs of double-sided materials.
struct ParticleState {
  ParticleState(const World& world, std::size_t texels, int layerCount)
      : layers(layerCount),
        caustics(castsCaustics(world)),
        flux(texels, caustics ? 2 * layerCount : layerCount) {}

  /// Plane of `flux` with what came by way of a diffuse surface.
  static int indirectPlane(int layer) { return layer; }
  /// The same by specular events only, at least one. Only where `caustics`.
  int causticPlane(int layer) const { return layers + layer; }

  int layers;
  bool caustics;
  FluxGrid flux;
  std::uint64_t emitted = 0;
};

struct ParticleOptions {
  std::uint64_t whole = 0;    ///< particles [0, whole) are followed through all surfaces
  std::uint64_t caustic = 0;  ///< so many after them only to the first diffuse surface
  std::uint32_t seed = 1;
  int threads = 0;                  ///< 0 = inline
  RayCounters* counters = nullptr;  ///< with `threads` 0: counts the rays, and logs them where it has a log

  std::uint64_t total() const { return whole + caustic; }
};

/// Emits particles [state.emitted, last), last <= options.total(), and follows them through every BSDF of the
/// tracer with Russian roulette; at each hit on a side that shows irradiance, deposits the flux that has met
/// a surface before in the texel hit: layer 0 for fronts, 1 for backs of double-sided materials. At each
/// surface either the diffuse lobe or the others are drawn, in proportion to what they reflect, and a
/// direction of those alone: so both kinds are unbiased by themselves. The `caustic` ones are aimed at
/// specular objects (emission_aim.h): their weights have the same mean, from many more. Deterministic for any
/// `threads` and any pauses: when a stop is requested it ends after whole batches, at least one, and
/// state.emitted says how far.
void traceParticles(const World& world, const TexelMap& texels, const ParticleOptions& options,
                    std::uint64_t last, const core::Progress& progress, ParticleState& state);

/// Watts of one mean particle of a kind when `emitted` are emitted: what a weight of 1 stands for.
double wattsPerWeight(const World& world, std::uint64_t emitted);

}  // namespace saccade::raytrace
