// Which meshes may be drawn without their back faces.
#pragma once

#include "core/scene/scene.h"

namespace saccade::render {

/// Every edge is met by as many triangles one way as the other (positions welded where bit-identical), and
/// every connected part encloses a positive volume: seen from outside, its front faces hide its back faces.
/// A room modelled with its faces inwards is not such a solid. Any thread.
bool isOutwardSolid(const core::Mesh& mesh);

}  // namespace saccade::render
