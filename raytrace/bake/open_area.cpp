#include "raytrace/bake/open_area.h"

#include <cmath>

#include "core/math/random.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint32_t kStream = 0x6f70u;  // keeps the random numbers apart from others'
/// What is nearer than this share of a texel's side covers it: it cannot be told from the surface.
constexpr float kReach = 0.25f;
constexpr std::uint32_t kFirstPoints = 8, kMostPoints = 32;

float openShare(const World& world, const TexelMap& texels, std::size_t texel, int layer) {
  RayCounters counters;
  const float reach = OpenArea::reach(texels, texel);
  std::uint32_t open = 0, count = 0;
  const auto probe = [&](std::uint32_t until) {
    for (; count < until; ++count) {
      core::PixelSampler random(kStream, static_cast<std::uint32_t>(layer), texel * kMostPoints + count, 0);
      const Vec2 place = random.next2D();
      const MeshPoint p = texels.pointOn(texel, random.next1D(), place.x, place.y);
      const Surface at =
          surfaceOn(world, p.object, world.firstTriangle(p.object) + p.triangle, p.b1, p.b2, layer == 0);
      open += !isCovered(world, at, reach, counters);
    }
  };
  probe(kFirstPoints);
  if (open != 0 && open != count) probe(kMostPoints);
  return static_cast<float>(open) / static_cast<float>(count);
}

}  // namespace

bool isCovered(const World& world, const Surface& at, float distance, RayCounters& counters) {
  Hit hit;
  if (!world.intersect(at.leave(at.ng), hit, counters)) return false;
  const CompiledMaterial& m = world.materialOf(hit.object);
  if (m.alphaMode == core::AlphaMode::blend || m.transmission > 0) return false;
  const bool facing = glm::dot(hit.ng, at.ng) < 0;
  if (m.emits() && (m.doubleSided || facing)) return false;  // it lights the point
  const bool within = world.closed(hit.object) && !facing;
  return within || hit.t < distance;
}

OpenArea::OpenArea(const TexelMap& texels, int layers) {
  for (int layer = 0; layer < layers; ++layer) areas_[layer].assign(texels.texelCount(), 0.0f);
}

std::size_t OpenArea::probe(const World& world, const TexelMap& texels, int layer, BlockRange blocks,
                            int threads, const core::Progress& progress) {
  return parallelTexels(threads, blocks, texels.texelCount(), progress, [&](std::size_t texel) {
    const std::int32_t chart = texels.chartOf(texel);
    if (chart < 0 || !(texels.area(texel) > 0)) return;
    if (layer == 1 && !texels.charts()[static_cast<std::size_t>(chart)].doubleSided) return;
    areas_[layer][texel] = texels.area(texel) * openShare(world, texels, texel, layer);
  });
}

float OpenArea::reach(const TexelMap& texels, std::size_t texel) {
  return kReach * std::sqrt(texels.area(texel));
}

}  // namespace saccade::raytrace
