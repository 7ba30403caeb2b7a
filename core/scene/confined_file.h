// Files that a scene file names: only regular files inside the scene's own folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/load_budget.h"

namespace saccade::core {

/// Largest scene, buffer or material file that is read.
inline constexpr std::uint64_t kMaxSceneBytes = 4ull << 30;

/// The path of `relative` (as written in a scene file, already decoded) under `folder`. Throws core::Error,
/// starting with `who`, for absolute paths, "..", names that leave the folder through a link, and anything
/// that is not a regular file.
std::filesystem::path confinedFile(const std::filesystem::path& folder, const std::string& relative,
                                   const std::string& who);

/// The same, but nothing for a file that is not there.
std::optional<std::filesystem::path> confinedFileIfThere(const std::filesystem::path& folder,
                                                         const std::string& relative, const std::string& who);

/// The whole of a regular file of at most kMaxSceneBytes, charged to `budget`. Throws core::Error.
std::vector<std::uint8_t> readSceneFile(const std::filesystem::path& file, LoadBudget& budget);

}  // namespace saccade::core
