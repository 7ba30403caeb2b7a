// The museum hall in parts. Hall: x -5..5, z -12..12, y 0..5; the visitor walks along z. Metres.
#pragma once

#include <cstdint>

#include "data/make_scenes/glb_writer.h"

namespace saccade::data {

inline constexpr float kHallHalfWidth = 5;
inline constexpr float kHallHalfLength = 12;
inline constexpr float kHallHeight = 5;
inline constexpr float kAisleHalfWidth = 1.15f;
inline constexpr float kColonnadeX = 3.15f;

/// Floor, walls, ceiling with light panels, colonnades.
void addHall(GlbWriter& glb);
/// Pictures in metal frames and mirrors on all four walls.
void addPictures(GlbWriter& glb);
/// Sculptures on plinths, vitrines, the centrepiece, benches, stanchions.
void addExhibits(GlbWriter& glb);

}  // namespace saccade::data
