// KHR_texture_transform.
#pragma once

#include <glm/mat3x2.hpp>

#include "core/scene/scene.h"

namespace saccade::core {

/// Texture uv = uvMatrix * (u, v, 1): offset + R(rotation) * (scale * uv). Positive angles turn the uv
/// counter-clockwise as the picture is seen (v runs down), the picture clockwise.
glm::mat3x2 uvMatrix(const TextureSlot& slot);

}  // namespace saccade::core
