// What stands in the gallery: closed shapes about a metre high with their feet at y = 0, and vase outlines.
#pragma once

#include "data/make_scenes/mesh_data.h"
#include "data/make_scenes/profiles.h"

namespace saccade::data {

MeshData torusKnot(int windings, int turns, int lengthSteps, int aroundSteps);
MeshData twistedRing();   ///< a flat band bent to a ring, twisted once
MeshData twistedTower();  ///< rounded square, turning and tapering upwards
MeshData flame();         ///< a slender leaning form
MeshData bean();          ///< a smooth mirror-like pebble, 2 m long, hollowed below
MeshData starfruit();     ///< a ball with five-fold waves
MeshData seashell();      ///< a tube that winds up and grows
MeshData beadTower();     ///< balls upon one another
MeshData crown();         ///< a ring with balls
MeshData bust();          ///< head and shoulders of revolution, chess-like
/// Hollow vessels with walls of real thickness; `shape` in [0, 4).
MeshData vase(int shape, int slices);

/// Fluted column, `height` high, with base and capital.
MeshData column(float height, float radius);

}  // namespace saccade::data
