// glTF materials and the textures they use.
#pragma once

#include "core/scene/gltf_gate.h"
#include "core/scene/scene.h"
#include "core/scene/tinygltf.h"

namespace saccade::core {

/// Fills scene.materials (index for index, then glTF's default material if a primitive has none) and
/// scene.textures (only those that are used; one per texture and colour space). Lengths are multiplied by
/// `unitScale` (metres per unit). Throws core::Error for an image that cannot be decoded and for Ward's lobe
/// of the wrong form.
void convertMaterials(const tinygltf::Model& model, const std::vector<EncodedImage>& images, float unitScale,
                      Scene& scene, LoadBudget& budget);

}  // namespace saccade::core
