#include "core/scene/confined_file.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"

namespace saccade::core {
namespace fs = std::filesystem;

fs::path confinedFile(const fs::path& folder, const std::string& relative, const std::string& who) {
  if (auto file = confinedFileIfThere(folder, relative, who)) return *file;
  throw Error(std::string(who).append(": '").append(relative).append("' does not exist beside the scene"));
}

std::optional<fs::path> confinedFileIfThere(const fs::path& folder, const std::string& relative,
                                            const std::string& who) {
  const std::string quoted = std::string("'").append(relative).append("'");
  const auto refuse = [&](const std::string& why) { throw Error(who + ": " + quoted + " " + why); };
  if (relative.empty() || relative.find('\0') != std::string::npos) refuse("is no file name");
  const fs::path named = fs::path(relative);
  if (named.is_absolute() || relative.front() == '\\')
    refuse("is absolute; only files beside the scene are read");
  if (std::any_of(named.begin(), named.end(), [](const fs::path& part) { return part == ".."; }))
    refuse("leaves the scene's folder");

  std::error_code failed;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, failed);
  if (failed) refuse("cannot be looked up: " + failed.message());
  fs::path real = fs::canonical(root / named, failed);
  if (failed) return std::nullopt;
  const auto [rootEnd, ignored] = std::mismatch(root.begin(), root.end(), real.begin(), real.end());
  if (rootEnd != root.end()) refuse("leaves the scene's folder through a link");
  if (!fs::is_regular_file(real, failed)) refuse("is not a regular file");
  return real;
}

std::vector<std::uint8_t> readSceneFile(const fs::path& file, LoadBudget& budget) {
  std::error_code failed;
  const std::uintmax_t size = fs::is_regular_file(file, failed) ? fs::file_size(file, failed) : 0;
  if (!failed && size > kMaxSceneBytes)
    throw Error(file.string() + ": " + std::to_string(size) + " bytes, more than the " +
                std::to_string(kMaxSceneBytes) + " this program reads");
  return readWholeFile(file, budget);
}

}  // namespace saccade::core
