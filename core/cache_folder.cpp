#include "core/cache_folder.h"

#include <cstdlib>

#include "core/error.h"

namespace saccade::core {

std::filesystem::path cacheFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && *cache == '/') return std::filesystem::path(cache) / "saccade";
  if (home != nullptr && *home != '\0') return std::filesystem::path(home) / ".cache" / "saccade";
  throw Error("no place to keep illumination maps and references: set XDG_CACHE_HOME or HOME");
}

std::string cacheName(std::uint64_t key) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string name;
  for (int shift = 60; shift >= 0; shift -= 4) name += kDigits[key >> shift & 15];
  return name;
}

}  // namespace saccade::core
