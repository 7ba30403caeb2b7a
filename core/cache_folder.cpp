#include "core/cache_folder.h"

#include <cstdlib>

#include "core/error.h"

namespace saccade::core {

namespace {

/// After the XDG Base Directory Specification: a variable that is no absolute path is ignored.
std::filesystem::path folderBy(const char* variable, const char* underHome, const std::string& what) {
  const char* base = std::getenv(variable);
  const char* home = std::getenv("HOME");
  if (base != nullptr && *base == '/') return std::filesystem::path(base) / "saccade";
  if (home != nullptr && *home != '\0') return std::filesystem::path(home) / underHome / "saccade";
  throw Error("no place to keep " + what + ": set " + variable + " or HOME");
}

}  // namespace

std::filesystem::path cacheFolder() {
  return folderBy("XDG_CACHE_HOME", ".cache", "illumination maps and references");
}

std::filesystem::path configFolder() {
  return folderBy("XDG_CONFIG_HOME", ".config", "settings and bookmarks");
}

std::string cacheName(std::uint64_t key) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string name;
  for (int shift = 60; shift >= 0; shift -= 4) name += kDigits[key >> shift & 15];
  return name;
}

}  // namespace saccade::core
