// Where tests write.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace saccade::tests {

/// A folder of this process that is removed at its end.
inline const std::filesystem::path& temporaryFolder() {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("saccade-test-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

}  // namespace saccade::tests
