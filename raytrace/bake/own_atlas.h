// Whether the second UV set that a mesh brings is an atlas that illumination maps can use as it is.
//
// Tolerances: coordinates may leave [0, 1] by 1e-4. Triangles with a thousandth of the area may be stretched
// beyond the bounds. Parts lie over each other when they fill a cell of a grid by more than 1.01; the grid
// has four cells for each texel that the mesh may take, at most 512 x 512, so overlaps narrower than half
// such a texel pass. A gutter's width is right to two cells, never too wide.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "core/scene/scene.h"

namespace saccade::raytrace {

/// Why a second UV set is not kept.
enum class AtlasFault {
  none,
  missing,
  notFinite,
  outside,    ///< [0, 1]
  flat,       ///< a triangle with area in space has none there
  stretched,  ///< density (per area) more than 4 times away from the mean, or one way 8 times the other
  wasteful,   ///< covers less than a quarter of its bounds
  creased,    ///< a chart bends around an edge where normals differ by 25 degrees: its texels mix two sides
  overlapping,
  crowded,  ///< with the texels that the mesh may take gutters are narrower than kGutterTexels
};
inline constexpr std::size_t kAtlasFaults = 10;
/// Texels between charts with which none shows in the look-ups of another: one at the border of each may hold
/// some of it, and the two that are filled for them lie between (gutters.h).
inline constexpr double kGutterTexels = 3;

/// What is wrong, as in "the second UV set ..."; empty for none.
const char* describe(AtlasFault fault);

/// Meshes by fault; those without one keep their second UV set as the layout of their charts.
using AtlasCounts = std::array<std::size_t, kAtlasFaults>;

struct OwnAtlas {
  AtlasFault fault = AtlasFault::missing;
  glm::dvec2 lo{0}, hi{0};   ///< bounds of uv1
  glm::dvec2 metres{0};      ///< that a unit of u and of v stands for, in the mesh's space; kept area
  double coarsestTexel = 0;  ///< metres: kGutterTexels fit into each gutter

  /// Place in a rectangle of the surface's size, from its corner.
  glm::dvec2 project(const core::Vec2& uv1) const { return (glm::dvec2(uv1) - lo) * metres; }
};

/// `mostTexels`: that the mesh may take. Looks at triangles and cells once each. Any thread.
OwnAtlas examineAtlas(const core::Mesh& mesh, double mostTexels);

}  // namespace saccade::raytrace
