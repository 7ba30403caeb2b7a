// Cuts one mesh into charts: connected, nearly planar sets of triangles that do not overlap when projected.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <stop_token>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::raytrace {

/// Triangles of one chart and their projection: p = ((x - origin) . u, (x - origin) . v), u x v = axis.
struct Chart {
  std::vector<std::uint32_t> triangles;  ///< ascending
  glm::dvec3 origin{0}, u{1, 0, 0}, v{0, 1, 0};
  glm::dvec2 lo{0}, hi{0};  ///< bounds of the projection, metres

  glm::dvec2 project(const core::Vec3& position) const {
    const glm::dvec3 d = glm::dvec3(position) - origin;
    return {glm::dot(d, u), glm::dot(d, v)};
  }
};

/// Every triangle is in exactly one chart; degenerate ones (no area, non-finite) share one chart without
/// extent. Charts turn so that their bounding rectangle is small; hollow ones (a window frame) are halved.
/// About a microsecond a triangle. Throws core::Error soon after `stop` was requested.
std::vector<Chart> clusterMesh(const core::Mesh& mesh, const std::stop_token& stop = {});

}  // namespace saccade::raytrace
