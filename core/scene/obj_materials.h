// MTL materials as metallic-roughness ones.
#pragma once

#include <tiny_obj_loader.h>

#include <filesystem>
#include <vector>

#include "core/load_budget.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// Appends one material per MTL material (classic ones and those of the PBR extension: docs/scenes.md), and
/// the textures they use from `folder` (missing or unreadable ones are left out with a warning). Throws
/// core::Error for a texture outside the folder.
void convertObjMaterials(const std::vector<tinyobj::material_t>& materials,
                         const std::filesystem::path& folder, Scene& scene, LoadBudget& budget);

}  // namespace saccade::core
