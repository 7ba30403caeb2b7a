// How fast a sample's correction is expected to change when the eye moves: what the aging test `change` goes
// by.
//
// What a mirror shows at a point changes as the reflected ray sweeps over the scene. The neighbours of a
// sample on the same object were traced for reflected rays that differ a little from its own, so what their
// corrections differ by for each radian between those rays says how rough the scene is that the sample
// reflects. Hit distances and roughness of the lobe were tried as further inputs and told nothing more
// (docs/results.md, "Validity of cached samples").
#pragma once

#include <span>

#include "core/corrective/messages.h"

namespace saccade::core {

/// Expected change, displayed, a radian, where nothing speaks for another.
inline constexpr float kUsualChangeRate = 0.3f;
/// Of a sample that was not estimated, or is alone.
inline constexpr float kUnknownChangeRate = 2 * kUsualChangeRate;

/// Fills Sample::changeRate of a job's samples: one object, one level, in lattice order. Any thread; takes
/// some 50 ns a sample.
void estimateChangeRates(std::span<Sample> samples);

}  // namespace saccade::core
