// Smooth normals for meshes that come without any.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace saccade::core {

/// One unit normal per corner (3 per triangle): the area-weighted mean of the normals of those triangles at
/// the same position (bit for bit) whose normals lie within `creaseDegrees` of the corner's own triangle's.
/// Corners of triangles without area get (0, 1, 0). Indices must be in range.
std::vector<Vec3> creaseNormals(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices,
                                float creaseDegrees);

}  // namespace saccade::core
