// Where files of the program's own are kept: what was computed once (illumination maps, references), and what
// a person set. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace saccade::core {

/// $XDG_CACHE_HOME/saccade, or ~/.cache/saccade; it may not exist yet. Throws core::Error where neither
/// variable names a place.
std::filesystem::path cacheFolder();

/// $XDG_CONFIG_HOME/saccade, or ~/.config/saccade; likewise.
std::filesystem::path configFolder();

/// 16 hexadecimal digits: the name of the file of this key, without its extension.
std::string cacheName(std::uint64_t key);

}  // namespace saccade::core
