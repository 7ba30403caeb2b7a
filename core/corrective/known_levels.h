// What warped samples already tell about a frame's pixels, so that tracers go where they tell least.
//
// Addition to Haber et al. 2001, whose regions begin at their first level with every camera and trace again
// what the cache holds. A sample of an older camera stands for its surroundings as a fresh one of a coarser
// level does: highlights and reflections have moved across the surface since. What that costs is measured by
// bench/walkorder.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace saccade::core {

/// The lattice level whose fresh samples tell as much as one of `level` (1 to Lattice::kMaxLevel) after
/// `cameraChanges` (>= 0): spacing and drift add as variances do, the drift is half a pixel with each camera,
/// and the level is the nearest one by the logarithm of its spacing. Never finer than `level`. Any thread.
int effectiveLevel(int level, std::int64_t cameraChanges);

/// By pixel of a frame, row 0 = top: the effective level of what warped samples show there, 0 where they show
/// nothing. Null: nothing is known of any pixel. Immutable.
using KnownLevels = std::shared_ptr<const std::vector<std::uint8_t>>;

}  // namespace saccade::core
