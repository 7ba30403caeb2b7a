// Illumination maps as pictures for viewers that know no irradiance (core/scene/export_gltf.h).
#pragma once

#include "core/maps.h"
#include "core/progress.h"
#include "core/scene/export_gltf.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// Largest side of pictures that are refined beyond the atlas, texels: in steps of 2, for textured colours
/// and for the maps' detail.
inline constexpr int kDetailedSide = 4096;

/// What the maps hold on `layer` (irradiance, W/m^2): their texels, or where they have detail, means of
/// look-ups in a picture finer than the atlas (a power of two, as fine as the detail). Row 0 at v = 0. `maps`
/// are those that were set on the world (World::setMaps). The result does not depend on `threads`. Throws
/// core::Error when stopped.
core::ImageRgb irradiancePicture(const World& world, const core::IlluminationMaps& maps, int layer,
                                 int threads, const core::Progress& progress);

/// What the base layer shows on every chart (baseLight: reflected diffusely, and emitted), meant over each
/// texel, and the irradiance over pi beside it, as fine as irradiancePicture. The texels of a material are
/// coded relative to its brightest one. Of a double-sided chart the side that receives more light counts, for
/// both sides. Texels within two of a chart continue it, the rest are black. `maps`, `threads` and errors as
/// there.
core::LightTextures makeLightTextures(const World& world, const core::IlluminationMaps& maps, int threads,
                                      const core::Progress& progress);

}  // namespace saccade::raytrace
