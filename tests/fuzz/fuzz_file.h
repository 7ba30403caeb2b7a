// What the fuzz targets share: input as a file of its own, because our readers take paths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/error.h"

namespace saccade::fuzz {

/// A folder in memory (/dev/shm), gone at exit.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  /// Overwrites the file `name` and returns its path. Aborts when it cannot: the run would test nothing.
  std::filesystem::path write(const std::string& name, std::span<const std::uint8_t> bytes) const;

 private:
  std::filesystem::path folder_;
};

/// The process's own folder.
const ScratchFolder& scratch();

/// Runs a reader. A refusal (core::Error) is a good answer; any other exception ends the process, which the
/// fuzzer reports.
template <class Read>
void mayRefuse(const Read& read) {
  try {
    read();
  } catch (const core::Error&) {
  }
}

/// Loads the file as a scene.
void loadScene(const std::filesystem::path& file);

}  // namespace saccade::fuzz
