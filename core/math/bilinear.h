// Interpolation between values at whole positions of a grid.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace saccade::core {

/// The bilinear mean of at(column, row) at the four whole positions around (x, y), float or double; where x
/// or y is whole, the next column or row is asked for too and counts nothing.
template <class Coordinate, class At>
auto bilinear(Coordinate x, Coordinate y, const At& at) {
  const Coordinate left = std::floor(x), top = std::floor(y);
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  const auto right = static_cast<float>(x - left), down = static_cast<float>(y - top);
  return glm::mix(glm::mix(at(column, row), at(column + 1, row), right),
                  glm::mix(at(column, row + 1), at(column + 1, row + 1), right), down);
}

}  // namespace saccade::core
