#include "raytrace/surface_points.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "raytrace/bake/charts.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint32_t kStream = 0x73757266u;  // keeps the random numbers apart from others'

/// Triangles that show irradiance, with the area of all before and including them, both sides counted.
class Areas {
 public:
  explicit Areas(const World& world) {
    const core::Scene& scene = world.scene();
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      const core::Material& material = scene.materials[static_cast<std::size_t>(scene.objects[o].material)];
      if (!showsIrradiance(material)) continue;
      const double sides = material.doubleSided ? 2 : 1;
      const glm::dmat3 meshToWorld(scene.objects[o].meshToWorld);
      for (std::uint32_t t = 0; t < world.triangleCountOf(o); ++t) {
        const Vec3* corner = world.shape(world.firstTriangle(o) + t).position;
        const double area = sides * 0.5 *
                            glm::length(glm::cross(meshToWorld * glm::dvec3(corner[1] - corner[0]),
                                                   meshToWorld * glm::dvec3(corner[2] - corner[0])));
        if (!(area > 0) || !std::isfinite(area)) continue;
        total_ += area;
        entries_.push_back({total_, o, t, material.doubleSided});
      }
    }
  }
  bool empty() const { return entries_.empty(); }

  /// `u` picks by area, `side` the side of double-sided ones; both in [0, 1).
  SurfacePoint at(double u, float side) const {
    const auto found = std::upper_bound(entries_.begin(), entries_.end(), u * total_,
                                        [](double x, const Entry& e) { return x < e.upTo; });
    const Entry& e = found == entries_.end() ? entries_.back() : *found;
    return {e.object, e.triangle, 0, 0, !e.doubleSided || side < 0.5f};
  }

 private:
  struct Entry {
    double upTo;
    std::uint32_t object, triangle;
    bool doubleSided;
  };
  std::vector<Entry> entries_;
  double total_ = 0;
};

}  // namespace

std::vector<SurfacePoint> surfacePoints(const World& world, std::size_t count, std::uint32_t seed) {
  const Areas areas(world);
  std::vector<SurfacePoint> out;
  if (areas.empty()) return out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    core::PixelSampler random(kStream, 0, i, seed);
    const double stratum = (static_cast<double>(i) + random.next1D()) / static_cast<double>(count);
    SurfacePoint p = areas.at(stratum, random.next1D());
    const Vec2 u = random.next2D();
    const float root = std::sqrt(u.x);
    p.b1 = root * (1 - u.y);
    p.b2 = root * u.y;
    out.push_back(p);
  }
  return out;
}

Vec3 mapIrradiance(const World& world, const SurfacePoint& at) {
  const std::uint32_t triangle = world.firstTriangle(at.object) + at.triangle;
  return world.irradiance(world.mapFootprint(at.object, triangle, at.b1, at.b2, at.front ? 0 : 1));
}

}  // namespace saccade::raytrace
