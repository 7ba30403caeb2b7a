#include "bench/maps/beside_cycles.h"

#include <optional>

#include "bench/maps/worst_points.h"
#include "bench/peers/cycles.h"

namespace saccade::bench {
namespace {

constexpr int kSamples = 64;  ///< a texel
constexpr double kAtlasTexels = 512.0 * 512.0;

/// The points that Cycles bakes, with what ours holds there.
struct FrontPoints {
  std::vector<CyclesPoint> where;
  std::vector<PointTruth> truth;
  std::vector<core::Vec3> ours;
};

FrontPoints frontPoints(const raytrace::World& world, const PointReference& reference, const OurBake& ours) {
  FrontPoints front;
  for (std::size_t i = 0; i < reference.points.size(); ++i) {
    const raytrace::SurfacePoint& p = reference.points[i];
    if (!p.front) continue;
    front.where.push_back({world.scene().objects[p.object].name, positionOf(world, p)});
    front.truth.push_back(reference.truth[i]);
    front.ours.push_back(ours.found[i]);
  }
  return front;
}

}  // namespace

void measureCyclesBake(Session& session, const std::string& file, const raytrace::World& world,
                       const PointReference& reference, const OurBake& ours, int threads) {
  const std::optional<std::string> blender = cyclesVersion();
  session.say("maps: Cycles' bake: " + blender.value_or(kCyclesMissing));
  Record record;
  record.key = "maps/" + sceneName(file) + "/cycles";
  record.labels = {{"scene", sceneName(file)},
                   {"method", "Cycles (" + blender.value_or("absent") + "), bake"}};
  if (!blender) {
    record.labels["status"] = kCyclesMissing;
    session.add(record, nullptr);
    return;
  }
  const LoadWatch watch;
  const FrontPoints front = frontPoints(world, reference, ours);
  const CyclesBake bake = bakeWithCycles(file, front.where, kSamples, threads,
                                         session.options().folder / "maps" / "cycles", session.stop());
  const MapError theirs = errorOf(bake.irradiance, front.truth);
  record.at = {{"spp", kSamples}};
  record.values = {{"seconds", Value::seconds({bake.bakeSeconds})},
                   {"relerr", Value::error(theirs.relative)},
                   {"relerr_ours", Value::error(errorOf(front.ours, front.truth).relative)},
                   {"bias", Value::error(theirs.bias)},
                   {"p99", Value::error(theirs.p99)},
                   {"texels", Value::count(kAtlasTexels)},
                   {"sooner_than_cycles", Value::ratio({bake.bakeSeconds / ours.seconds}, Better::higher)}};
  record.values["bias"].better = Better::neither;
  session.add(record, &watch);
}

}  // namespace saccade::bench
