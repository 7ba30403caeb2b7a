#include "raytrace/bake/imported_light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/bilinear.h"
#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {
namespace {

using core::Vec2;
using core::Vec3;

/// Points on a texel's surface, evenly spread over its area.
constexpr int kPoints = 16;

/// Base-2 radical inverse of a number below 16.
float mirrored(int i) {
  constexpr float kReversed[] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
  return (kReversed[i] + 0.5f) / kPoints;
}

Vec3 bilinear(const core::ImageRgb& image, Vec2 uv) {
  for (int axis = 0; axis < 2; ++axis)
    if (uv[axis] < 0 || uv[axis] > 1) uv[axis] -= std::floor(uv[axis]);
  const Vec2 p = uv * Vec2(image.width(), image.height()) - 0.5f;
  return core::bilinear(p.x, p.y, [&](int column, int row) {
    return image.at(std::clamp(column, 0, image.width() - 1), std::clamp(row, 0, image.height() - 1));
  });
}

Vec2 lightmapUv(const core::Mesh& mesh, const MeshPoint& p) {
  const std::uint32_t* corner = mesh.indices.data() + std::size_t{3} * p.triangle;
  return mesh.uv1[corner[0]] * (1 - p.b1 - p.b2) + mesh.uv1[corner[1]] * p.b1 + mesh.uv1[corner[2]] * p.b2;
}

}  // namespace

bool hasLightmapUv(const core::Mesh& mesh) {
  return !mesh.uv1.empty() && std::all_of(mesh.uv1.begin(), mesh.uv1.end(), [](const Vec2& uv) {
    return std::isfinite(uv.x) && std::isfinite(uv.y);
  });
}

void importIrradiance(const TexelMap& texels, const core::Scene& charted, const ImportedLight& imported,
                      int threads, std::span<core::Vec3> irradiance) {
  const int size = texels.size();
  parallelRows(size, threads, {}, [&](int y, int) {
    for (int x = 0; x < size; ++x) {
      const auto texel = static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x);
      if (texels.chartOf(texel) < 0) continue;
      const int image = imported.imageOfObject[texels.fragments(texel).front().object];
      if (image < 0) continue;
      Vec3 sum(0);
      for (int i = 0; i < kPoints; ++i) {
        const MeshPoint p = texels.pointOn(texel, (static_cast<float>(i) + 0.5f) / kPoints, mirrored(i),
                                           (static_cast<float>(i * 7 % kPoints) + 0.5f) / kPoints);
        sum += bilinear(imported.images[static_cast<std::size_t>(image)],
                        lightmapUv(charted.meshOf(charted.objects[p.object]), p));
      }
      irradiance[texel] = sum / static_cast<float>(kPoints);
    }
  });
}

}  // namespace saccade::raytrace
