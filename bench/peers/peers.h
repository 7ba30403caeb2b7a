// Seconds to equal error, beside other renderers.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// The glossy Cornell room of the shared folder (references/cycles; left out where it is absent): Blender's
/// Cycles, where installed, beside `corrective --converge` at several samples a pixel and qualities of the
/// maps, and `path`. Each is judged against a reference of its own model: Cycles' picture of 4,096 samples,
/// our path-traced one; the difference between the two is Blender's diffuse lobe, and has a record. Errors
/// are relative MSE with the reference's own noise taken out.
///
/// Keys, under "peers/cornell_glossy/": RENDERER@8spp, a point of a curve; RENDERER/to-0.013, the seconds to
/// that error and how many times sooner than Cycles; "-baked" behind a renderer counts the baking of its maps
/// too. ready-RENDERER: what nobody's seconds count. model: the difference of the references. rest/PART: what
/// is left of corrective's error.
void measurePeers(Session& session);

}  // namespace saccade::bench
