#include "core/scene/crease_normals.h"

#include <cmath>
#include <span>

#include "core/scene/mesh_repair.h"

namespace saccade::core {
namespace {

/// A vertex that more triangles share than this is the hub of a fan or damage: its corners stay flat, and the
/// work stays linear.
constexpr std::size_t kLargestValence = 256;

}  // namespace

std::vector<Vec3> creaseNormals(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices,
                                float creaseDegrees) {
  const std::size_t triangles = indices.size() / 3;
  const std::vector<std::uint32_t> weld = weldedVertices(positions);
  std::vector<glm::dvec3> across(triangles);  // length: twice the area
  std::vector<Vec3> unit(triangles, Vec3(0, 1, 0));
  std::vector<std::uint32_t> start(positions.size() + 1, 0);
  for (std::size_t t = 0; t < triangles; ++t) {
    const glm::dvec3 a(positions[indices[3 * t]]);
    across[t] = glm::cross(glm::dvec3(positions[indices[3 * t + 1]]) - a,
                           glm::dvec3(positions[indices[3 * t + 2]]) - a);
    const double length = glm::length(across[t]);
    if (length > 0 && std::isfinite(length)) {
      unit[t] = Vec3(across[t] / length);
    } else {
      across[t] = glm::dvec3(0);
    }
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) ++start[weld[indices[k]] + 1];
  }
  for (std::size_t v = 0; v < positions.size(); ++v) start[v + 1] += start[v];
  std::vector<std::uint32_t> around(3 * triangles), filled(start.begin(), start.end() - 1);
  for (std::size_t k = 0; k < 3 * triangles; ++k)
    around[filled[weld[indices[k]]]++] = static_cast<std::uint32_t>(k / 3);

  const float cosCrease = std::cos(glm::radians(creaseDegrees));
  std::vector<Vec3> normals(3 * triangles);
  for (std::size_t k = 0; k < 3 * triangles; ++k) {
    const Vec3& own = unit[k / 3];
    const std::uint32_t v = weld[indices[k]];
    const std::span<const std::uint32_t> faces(around.data() + start[v], around.data() + start[v + 1]);
    glm::dvec3 sum(0);
    if (faces.size() <= kLargestValence)
      for (const std::uint32_t f : faces)
        if (glm::dot(unit[f], own) >= cosCrease) sum += across[f];
    const double length = glm::length(sum);
    normals[k] = length > 0 ? Vec3(sum / length) : own;
  }
  return normals;
}

}  // namespace saccade::core
