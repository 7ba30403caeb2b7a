// The structural rules of glTF 2.0 that the gate enforces on parsed JSON.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/gltf_element.h"

namespace saccade::core {

/// Version, required extensions (known ones in `supported`); warns of optional ones that are not supported.
void checkAsset(const Element& root, std::span<const char* const> supported, Warnings& warnings);
/// bufferViews and accessors against the buffers' lengths, sparse indices against their content.
void checkAccessors(const Element& root, const std::vector<std::vector<std::uint8_t>>& buffers);
/// meshes, materials, textures, cameras, lights, nodes (ranges, parents, cycles), scenes.
void checkReferences(const Element& root);

}  // namespace saccade::core
