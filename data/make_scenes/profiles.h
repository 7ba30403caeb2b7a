// Outlines in the (radius, height) half-plane, and the solids of revolution they make.
#pragma once

#include <vector>

#include "data/make_scenes/mesh_data.h"

namespace saccade::data {

/// A point of an outline with its unit normal; x = distance from the axis in metres, y = height.
/// Outlines run so that the outside lies to the right: up on the outside of a body, down on its inside.
struct ProfilePoint {
  Vec2 position;
  Vec2 normal;
};
using Profile = std::vector<ProfilePoint>;

/// A corner of a polygonal outline. radius 0 = sharp edge (two points with different normals).
struct Corner {
  Vec2 position;
  float radius = 0;
};

/// Straight lines with rounded corners; `arcSteps` segments a corner; exact normals.
Profile roundedProfile(const std::vector<Corner>& corners, int arcSteps);

/// Centripetal Catmull-Rom spline through `points`, `steps` segments between neighbours.
Profile splineProfile(const std::vector<Vec2>& points, int steps);

/// Half circle around the origin from the lower to the upper pole.
Profile sphereProfile(float radius, int stacks);

/// Full circle of `minor` around (major, 0): a torus.
Profile torusProfile(float major, float minor, int steps);

/// Revolves the outline around the Y axis. Closed (watertight once equal positions are welded) when the
/// outline begins and ends on the axis or where it began. u runs around, v down the outline.
MeshData lathe(const Profile& profile, int slices);

}  // namespace saccade::data
