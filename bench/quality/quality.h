// How far is the converged picture from the path-traced one, and what is the rest made of?
#pragma once

#include "bench/harness/experiment.h"
#include "core/image.h"

namespace saccade::bench {

/// `corrective --converge` at 256 x 256 with medium maps against the reference, then with one cause after
/// another taken away. Records "quality/SCENE/STEP", FLIP and relative MSE: reference-noise (of the reference
/// itself), corrective, without-glossy-noise (64 sub-samples a pixel), without-aliasing (rendered four times
/// as large and filtered down), maps (the base layer alone, on diffuse pixels). left-out: mean albedo of the
/// lobes that objects treated as diffuse have and nobody shows.
void measureQuality(Session& session);

/// Means of factor x factor pixels; both sides are multiples of `factor`.
core::ImageRgb boxFiltered(const core::ImageRgb& large, int factor);

}  // namespace saccade::bench
