// View frustum culling over the object hierarchy. Conservative: what it drops cannot touch a pixel.
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/scene/scene.h"

namespace saccade::render {

/// 1 for each object of the scene whose bounds may be in view, else 0; all 1 for a scene without a hierarchy.
/// `visible` is resized to fit. Any thread.
void findVisible(const core::Scene& scene, const core::View& view, std::vector<char>& visible);

}  // namespace saccade::render
