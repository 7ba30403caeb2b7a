// The two file formats behind loadScene. What they return is not yet completed (completeScene).
#pragma once

#include <filesystem>

#include "core/scene/load.h"

namespace saccade::core {

Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options, LoadBudget& budget);
Scene loadObj(const std::filesystem::path& file, const LoadOptions& options, LoadBudget& budget);

}  // namespace saccade::core
