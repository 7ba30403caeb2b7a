// Where `saccade attention` writes its maps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace saccade::app {

/// The map's file for each image: `output` itself when it ends in .png or .exr, else IMAGE's stem + .png in
/// the folder `output`; nothing when `output` is empty. Throws core::UsageError for several images into one
/// file or for a name of another kind, core::Error when the folder of a map is missing, two maps would have
/// one name, when a map would replace one of the images, or when a file stands where the folder should. Makes
/// nothing.
std::vector<std::filesystem::path> attentionOutputs(const std::vector<std::string>& images,
                                                    const std::string& output);

}  // namespace saccade::app
