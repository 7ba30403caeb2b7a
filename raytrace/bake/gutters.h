// The texels along and around charts' borders, so that bilinear look-ups there read the chart's own light.
#pragma once

#include <span>

#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

/// Texels that a border cuts get the light at their centre, by the slope around them, instead of the mean
/// over what they cover. Texels without surface within two texels of a chart get the linear continuation of
/// the chart's values (bounded to half and double of the nearest), so that two charts that meet at an edge
/// agree there to first order; the rest become 0.
void fillGutters(const TexelMap& texels, std::span<core::Vec3> irradiance);

}  // namespace saccade::raytrace
