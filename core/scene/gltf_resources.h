// The buffers and images that a glTF file names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/glb_chunks.h"
#include "core/scene/gltf_element.h"
#include "core/scene/gltf_gate.h"

namespace saccade::core {

/// Where a glTF file's resources come from and what they may cost. The parts must outlive it.
struct GltfSource {
  const std::filesystem::path folder;
  const GltfParts& parts;
  Repairs& repairs;
  LoadBudget& budget;
};

/// Every buffer, exactly byteLength long. Throws core::Error for one that is missing, shorter than stated, or
/// whose URI is neither data: nor a file of the folder.
std::vector<std::vector<std::uint8_t>> readBuffers(const Element& root, const GltfSource& source);

/// Every image's bytes, PNG or JPEG with a header in order; those of another format are empty and counted,
/// and so are images whose stated type is not theirs.
std::vector<EncodedImage> readImages(const Element& root,
                                     const std::vector<std::vector<std::uint8_t>>& buffers,
                                     const GltfSource& source);

}  // namespace saccade::core
