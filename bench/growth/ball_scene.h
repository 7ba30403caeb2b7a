// Scenes of any size, made in memory: a wall of balls, all of them in view.
#pragma once

#include <cstddef>

#include "core/scene/scene.h"

namespace saccade::bench {

struct BallScene {
  std::size_t triangles = 100'000;  ///< of all balls, about; tells the tessellation
  std::size_t balls = 100;          ///< half of them mirrors (non-diffuse), half diffuse, alternating
  bool instanced = false;           ///< one mesh placed so often, or a copy for each
};

/// The finest tessellation of a ball (2 * rings segments) that has at most `triangles`, or the coarsest there
/// is.
int ringsFor(std::size_t triangles);
/// What a ball of so many rings has.
std::size_t trianglesOfBall(int rings);

/// Completed (core::completeScene), with a panel of light and a camera that sees all balls. What it really
/// holds is counted from it.
core::Scene makeBallScene(const BallScene& size);

}  // namespace saccade::bench
