// Where what was computed once is kept: illumination maps, references. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace saccade::core {

/// $XDG_CACHE_HOME/saccade, or ~/.cache/saccade; it may not exist yet. Throws core::Error where neither
/// variable names a place.
std::filesystem::path cacheFolder();

/// 16 hexadecimal digits: the name of the file of this key, without its extension.
std::string cacheName(std::uint64_t key);

}  // namespace saccade::core
