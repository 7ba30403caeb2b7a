// Seams: where a smooth surface is cut into charts, and both sides' texels should show the same light.
#pragma once

#include <span>
#include <vector>

#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

/// An edge of the surface that lies in the atlas twice: its ends there, in texels.
struct Seam {
  Plane2 from[2], to[2];     ///< of either side
  bool doubleSided = false;  ///< both sides are
};

/// The edges that two triangles of different charts share, of one object or two, where the shading normals at
/// both ends agree within 25 degrees and both sides show irradiance.
std::vector<Seam> findSeams(const TexelMap& texels);

/// Changes texels around seams as little as it takes for the bilinear look-ups of both sides to agree along
/// them (Kaczmarz' projections, in turn on each of two points a texel). Where they differ by more than a
/// quarter light itself may have a step there (a wall that stands on the seam): left alone. `irradiance`: of
/// a layer, gutters filled; `backs`: it is that of the backs.
void stitchSeams(std::span<const Seam> seams, int size, bool backs, std::span<core::Vec3> irradiance);

}  // namespace saccade::raytrace
