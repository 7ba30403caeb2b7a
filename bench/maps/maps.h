// Illumination maps: error against seconds, beside path tracing from every texel and Cycles' bake.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// Maps of each quality, and with more particles, against the path-traced irradiance of 4,096 seeded points
/// (point_reference.h). Their seconds are those of `saccade bake`: file, charts, trees, light, file. The
/// gather's are those of opening the scene with its maps (so that charts count nowhere) and of its paths.
///
/// Keys, under "maps/SCENE/": QUALITY, QUALITY-x4 (four times the particles), gather@4paths: points of the
/// curves, with relerr (map_error.h); reference: its own noise; to-0.05: seconds to that error of both and
/// their quotient; cycles: Blender's bake, cornell_glossy alone; rate-STAGE (see
/// bake_rates.h). OUT/maps/SCENE-QUALITY-worst.csv names the points that are farthest off.
///
/// Scenes of another person (shared folder, --scene) are left out with a line where they are absent.
void measureMaps(Session& session);

}  // namespace saccade::bench
