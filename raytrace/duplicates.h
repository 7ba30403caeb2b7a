// Triangles that lie exactly on one another.
#pragma once

#include <span>
#include <vector>

#include "raytrace/world.h"

namespace saccade::raytrace {

/// By triangle: has the same three corners as an earlier one of the same space, in any order. Which of the
/// two a ray meets first would be left to the order in which trees are built.
std::vector<bool> findDuplicates(std::span<const TriangleShape> shapes);

}  // namespace saccade::raytrace
