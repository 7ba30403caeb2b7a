#include "bench/maps/worst_points.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/atomic_file.h"
#include "raytrace/surface.h"

namespace saccade::bench {
namespace {

struct Miss {
  std::size_t point = 0;
  double squared = 0;
};

/// A CSV field that may hold anything.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

core::Vec3 positionOf(const raytrace::World& world, const raytrace::SurfacePoint& p) {
  const std::uint32_t triangle = world.firstTriangle(p.object) + p.triangle;
  return raytrace::surfaceOn(world, p.object, triangle, p.b1, p.b2, p.front).position;
}

void writeWorstPoints(const std::filesystem::path& file, const raytrace::World& world,
                      const PointReference& reference, std::span<const core::Vec3> found, std::size_t count) {
  std::vector<Miss> misses;
  double total = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double off =
        double{core::luminance(found[i])} - double{core::luminance(reference.truth[i].irradiance)};
    misses.push_back({i, off * off});
    total += off * off;
  }
  std::sort(misses.begin(), misses.end(), [](const Miss& a, const Miss& b) { return a.squared > b.squared; });
  misses.resize(std::min(misses.size(), count));
  std::string text = "x,y,z,object,side,map,reference,deviation,share\n";
  for (const Miss& m : misses) {
    const raytrace::SurfacePoint& p = reference.points[m.point];
    const core::Vec3 at = positionOf(world, p);
    char numbers[200];
    std::snprintf(numbers, sizeof numbers, "%.4f,%.4f,%.4f,", double{at.x}, double{at.y}, double{at.z});
    text += numbers + quoted(world.scene().objects[p.object].name) + (p.front ? ",front," : ",back,");
    const PointTruth& truth = reference.truth[m.point];
    std::snprintf(numbers, sizeof numbers, "%.5g,%.5g,%.2g,%.3f\n", double{core::luminance(found[m.point])},
                  double{core::luminance(truth.irradiance)}, std::sqrt(truth.variance),
                  total > 0 ? m.squared / total : 0);
    text += numbers;
  }
  std::filesystem::create_directories(file.parent_path());
  core::writeFileAtomically(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace saccade::bench
