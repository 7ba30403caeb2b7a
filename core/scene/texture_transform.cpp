#include "core/scene/texture_transform.h"

#include <cmath>

namespace saccade::core {

// The draft of the extension prints the rotation transposed; its text and its example (the lower left
// quadrant, turned clockwise) are as here.
glm::mat3x2 uvMatrix(const TextureSlot& slot) {
  const float c = std::cos(slot.rotation), s = std::sin(slot.rotation);
  return {slot.scale.x * Vec2(c, -s), slot.scale.y * Vec2(s, c), slot.offset};
}

}  // namespace saccade::core
