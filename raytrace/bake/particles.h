// Particle tracing for the illumination maps: Haber 2001, section 4, after its reference 39 (Volevich,
// Myszkowski, Khodulev, Kopylov: density estimation particle tracing); Shirley, Wade, Hubbard, Zareski,
// Walter, Greenberg, "Global Illumination via Density Estimation", 1995.
//
// Departure: particles carry indirect light only. What arrives straight from a light is integrated per texel
// (direct.h): direct light dominates the error of a pure particle method, has its sharpest edges (shadows),
// and stratified shadow rays reach a given error with far fewer rays than photon counts, whose error falls as
// 1 / sqrt(n). Particles keep what shadow rays cannot find: all further bounces and caustics.
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

  FluxGrid(std::size_t texels, int layers) : texels_(texels), cells_(texels * layers) {}

  /// Any thread, concurrently. weight = flux / mean particle's flux.
  void add(std::size_t texel, int layer, const Vec3& weight);
  Cell& cell(std::size_t texel, int layer) { return cells_[layer * texels_ + texel]; }
  const Cell& cell(std::size_t texel, int layer) const { return cells_[layer * texels_ + texel]; }
  std::span<Cell> cells() { return cells_; }  ///< texels of layer 0, then of layer 1

 private:
  std::size_t texels_;
  std::vector<Cell> cells_;
};

/// All that particle tracing has found so far. Sums and the number of finished particles suffice to go on
/// later: particle i is a function of (i, seed) alone.
struct ParticleState {
  ParticleState(std::size_t texels, int layers) : flux(texels, layers) {}
  FluxGrid flux;
  std::uint64_t emitted = 0;
};

/// Emits particles [state.emitted, total) and follows them through every BSDF of the tracer with Russian
/// roulette; at each hit on a side that shows irradiance, deposits the indirect flux in the texel hit: layer
/// 0 for fronts, 1 for backs of double-sided materials. Deterministic for any `threads` (0 = inline) and any
/// pauses: when a stop is requested it ends after whole batches, at least one, and state.emitted says how
/// far.
void traceParticles(const World& world, const TexelMap& texels, std::uint64_t total, std::uint32_t seed,
                    int threads, const core::Progress& progress, ParticleState& state);

/// Watts of one mean particle when `emitted` are emitted: what a weight of 1 stands for.
double wattsPerWeight(const World& world, std::uint64_t emitted);

}  // namespace saccade::raytrace
