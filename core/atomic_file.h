// Whole files: read with the checks that user input needs, written so that a reader sees the old or the new
// one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/load_budget.h"

namespace saccade::core {

/// Throws core::Error unless `file` is a regular file (no folder, FIFO or device) that can be read. Any
/// thread.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& file);
/// As many bytes as `budget` has left at most; they stay charged.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& file, LoadBudget& budget);

/// Writes beside `file` under a temporary name of its own and renames: after a failure, a kill or beside a
/// second writer the old file or a new one is there, whole. Throws core::Error, leaving no temporary file.
/// Any thread.
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace saccade::core
