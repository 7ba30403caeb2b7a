#include "bench/maps/bake_rates.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "bench/harness/machine.h"
#include "bench/harness/trials.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/gather.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/ray_log.h"

namespace saccade::bench {
namespace {

constexpr std::uint64_t kParticles = 1 << 16;
constexpr std::size_t kBlocks = 48;  ///< of texels, spread over the atlas

/// A piece of a stage that is always the same: the same rays in the same order.
struct Piece {
  std::string name, unit;
  double units = 0;  ///< in one run
  std::function<void(raytrace::RayCounters&)> run;
};

raytrace::TexelLight lightOf(const core::IlluminationMaps& maps) {
  raytrace::TexelLight light;
  for (int layer = 0; layer < maps.layers; ++layer) {
    for (int y = 0; y < maps.height; ++y) {
      for (int x = 0; x < maps.width; ++x) light.layers[layer].push_back(maps.texel(x, y, layer));
    }
  }
  return light;
}

/// The stages of one scene on the calling thread.
class Stages {
 public:
  Stages(const app::Workspace& opened, std::uint32_t seed)
      : world_(*opened.world),
        texels_(opened.scene, opened.maps.width),
        open_(texels_, 1),
        seed_(seed),
        light_(lightOf(opened.maps)),
        particles_(world_, texels_.texelCount(), opened.maps.layers),
        estimates_(texels_.texelCount()) {
    blocks_.last = std::min(kBlocks, raytrace::allBlocks(texels_.texelCount()).last);
    open_.probe(world_, texels_, 0, blocks_, 0, {});
  }

  std::vector<Piece> pieces() {
    const auto texels = static_cast<double>(coveredTexels());
    return {{"particles", "particles", static_cast<double>(kParticles),
             [this](raytrace::RayCounters& counters) {
               particles_.emitted = 0;
               raytrace::ParticleOptions options;
               options.whole = kParticles;
               options.seed = seed_;
               options.counters = &counters;
               raytrace::traceParticles(world_, texels_, options, kParticles, {}, particles_);
             }},
            {"direct", "texels", texels,
             [this](raytrace::RayCounters& counters) {
               raytrace::DirectOptions options;
               options.seed = seed_;
               options.counters = &counters;
               raytrace::directIrradiance(world_, texels_, open_, 0, blocks_, options, {}, estimates_);
             }},
            {"gather", "texels", texels, [this](raytrace::RayCounters& counters) {
               raytrace::GatherOptions options;
               options.seed = seed_;
               options.counters = &counters;
               raytrace::gatherIrradiance(world_, texels_, open_, 0, blocks_, light_, options, {},
                                          estimates_);
             }}};
  }

 private:
  /// Of the blocks: those of the fronts' layer that a stage works on.
  std::size_t coveredTexels() {
    std::size_t count = 0;
    raytrace::parallelTexels(0, blocks_, texels_.texelCount(), {}, [&](std::size_t texel) {
      count += texels_.chartOf(texel) >= 0 && texels_.area(texel) > 0;
    });
    return count;
  }

  const raytrace::World& world_;
  raytrace::TexelMap texels_;
  raytrace::OpenArea open_;
  std::uint32_t seed_;
  raytrace::TexelLight light_;
  raytrace::ParticleState particles_;
  std::vector<raytrace::DirectEstimate> estimates_;
  raytrace::BlockRange blocks_;
};

Record measure(const Piece& piece, const raytrace::World& world, const std::stop_token& stop) {
  raytrace::RayLog log;
  raytrace::RayCounters logged;
  logged.log = &log;
  piece.run(logged);
  const auto rays = static_cast<double>(log.entries().size());
  std::vector<double> loop, bare, units;
  alternate(2, kRepeats, stop, [&](int variant, int round) {
    raytrace::RayCounters counters;
    const double seconds =
        variant == 0 ? timed([&] { piece.run(counters); }) : timed([&] { raytrace::replayRays(world, log); });
    if (round < 0) return;
    (variant == 0 ? loop : bare).push_back(rays / seconds);
    if (variant == 0) units.push_back(piece.units / seconds);
  });
  Record record;
  record.values = {{piece.unit + "_per_second", Value::rate(units)},
                   {"loop", Value::rate(loop)},
                   {"bare", Value::rate(bare)},
                   {"ratio", Value::ratio(ratios(loop, bare), Better::higher)},
                   {"rays_per_unit", Value::count(rays / piece.units)}};
  return record;
}

}  // namespace

void measureBakeRates(Session& session, const std::string& scene, const app::Workspace& opened) {
  const Pinned main(mainCores());
  Stages stages(opened, session.options().seed);
  for (const Piece& piece : stages.pieces()) {
    session.say("maps: " + scene + ", rays of " + piece.name);
    if (!(piece.units > 0)) continue;
    const LoadWatch watch;
    Record record = measure(piece, *opened.world, session.stop());
    record.key = "maps/" + scene + "/rate-" + piece.name;
    record.labels = {{"scene", scene}, {"stage", piece.name}};
    session.add(record, &watch);
  }
}

}  // namespace saccade::bench
