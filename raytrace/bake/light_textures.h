// Illumination maps as pictures for viewers that know no irradiance (core/scene/export_gltf.h).
#pragma once

#include "core/maps.h"
#include "core/progress.h"
#include "core/scene/export_gltf.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// Side of the pictures of outgoing light where colours are textured, texels: such an atlas is refined in
/// steps of 2 while it fits.
inline constexpr int kDetailedSide = 4096;

/// What the base layer shows on every chart (baseLight: reflected diffusely, and emitted), meant over each
/// texel, and the irradiance over pi beside it. The texels of a material are coded relative to its brightest
/// one. Of a double-sided chart the side that receives more light counts, for both sides. Texels within two
/// of a chart continue it, the rest are black. `maps` are those that were set on the world
/// (World::setMaps). The result does not depend on `threads`. Throws core::Error when stopped.
core::LightTextures makeLightTextures(const World& world, const core::IlluminationMaps& maps, int threads,
                                      const core::Progress& progress);

}  // namespace saccade::raytrace
