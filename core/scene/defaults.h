// The light and the camera of a scene that brings none (design, Conventions).
#pragma once

#include "core/scene/scene.h"

namespace saccade::core {

/// What surrounds the middle of a scene, found with rays from there.
struct Surroundings {
  bool open[4] = {true, true, true, true};  ///< the sides +x, -x, +z, -z let most rays through
  bool interior = false;                    ///< a floor and at least three sides, seen from their front
};
/// The scene's bounds must be known and not empty, here and below.
Surroundings look(const Scene& scene);

/// The scene's emitting objects together would give the faces of its bounds less than 0.05 W/m^2 on average
/// in a room, 0.25 elsewhere (none included): a lit label, windows painted white. One sees nothing by them.
bool onlyDimEmitters(const Scene& scene, const Surroundings& around);

/// A room of more than 100 m height: its unit is hardly the metre.
bool isNoMetreRoom(const Scene& scene, const Surroundings& around);

/// Adds an object emitting downwards, one metre square at 0.95 of the room's height, radiance 15; over floors
/// of more than 200 m^2 it is larger by as much, so that rooms of any unit are lit. Departure:
/// a scene that is no room gets it above its bounds on the first camera's side, half as wide as their
/// diagonal, so that things of any size are lit alike, where one looks at them.
void addDefaultLight(Scene& scene, const Surroundings& around);

/// 60 degrees. In a closed room: at eye height (of a room that is none in metres: 0.6 of its own) near one
/// end, looking along the longest free way. In a room with one open side: outside it. Else three-quarter view
/// from outside.
Camera defaultCamera(const Scene& scene, const Surroundings& around);

/// A rectangle facing `direction` as a new node, object and emitting material.
void addPanel(Scene& scene, const std::string& name, const Vec3& center, Vec2 size, const Vec3& direction,
              const Vec3& radiance);

}  // namespace saccade::core
