#include "tests/fuzz/fuzz_file.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "core/scene/load.h"

namespace saccade::fuzz {

ScratchFolder::ScratchFolder() : folder_("/dev/shm/saccade-fuzz-" + std::to_string(getpid())) {
  std::filesystem::create_directories(folder_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path ScratchFolder::write(const std::string& name,
                                           std::span<const std::uint8_t> bytes) const {
  const std::filesystem::path file = folder_ / name;
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out || std::fwrite(bytes.data(), 1, bytes.size(), out) != bytes.size() || std::fclose(out) != 0) {
    std::perror(file.c_str());
    std::abort();
  }
  return file;
}

const ScratchFolder& scratch() {
  static const ScratchFolder folder;
  return folder;
}

void loadScene(const std::filesystem::path& file) {
  mayRefuse([&] { core::loadScene(file, {}); });
}

}  // namespace saccade::fuzz
