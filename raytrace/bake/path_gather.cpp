#include "raytrace/bake/path_gather.h"

#include "core/math/random.h"
#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint32_t kPlaceStream = 0x706c'6163u;  // keeps places in a texel apart from paths

Vec3 gatherTexel(const World& world, const TexelMap& texels, std::size_t texel, int layer,
                 const PathGatherOptions& options, RayCounters& counters) {
  const auto stream =
      static_cast<std::uint32_t>(texel + static_cast<std::size_t>(layer) * texels.texelCount());
  PathOptions path;
  path.bounces = options.bounces;
  path.seed = options.seed;
  Vec3 sum(0);
  for (std::uint64_t i = options.firstPath; i < options.firstPath + options.paths; ++i) {
    core::PixelSampler random(stream, kPlaceStream, i, options.seed);
    const float part = random.next1D();
    const Vec2 place = random.next2D();
    const MeshPoint on = texels.pointOn(texel, part, place.x, place.y);
    path.firstSample = i;
    sum += irradiancePath(world, {on.object, on.triangle, on.b1, on.b2, layer == 0}, stream, path, counters);
  }
  return sum;
}

}  // namespace

void gatherPaths(const World& world, const TexelMap& texels, int layer, const PathGatherOptions& options,
                 const core::Progress& progress, std::span<Vec3> sums) {
  const int side = texels.size();
  parallelRows(side, options.threads, progress, [&](int y, int) {
    RayCounters counters;
    for (int x = 0; x < side; ++x) {
      const std::size_t texel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
      const std::int32_t chart = texels.chartOf(texel);
      if (chart < 0 || !(texels.area(texel) > 0)) continue;
      if (layer == 1 && !texels.charts()[static_cast<std::size_t>(chart)].doubleSided) continue;
      sums[texel] += gatherTexel(world, texels, texel, layer, options, counters);
    }
  });
}

}  // namespace saccade::raytrace
