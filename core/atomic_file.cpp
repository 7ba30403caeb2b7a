#include "core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;

/// A file that disappears unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) {
    static std::atomic<unsigned> count = 0;
    path_ = target;
    path_ += ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
    descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (created_) ::unlink(path_.c_str());
  }
  bool write(std::span<const std::uint8_t> bytes) {
    if (descriptor_ < 0) return false;
    created_ = true;
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return ::close(std::exchange(descriptor_, -1)) == 0;
  }
  bool renameTo(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) return false;
    created_ = false;
    return true;
  }

 private:
  fs::path path_;
  int descriptor_ = -1;
  bool created_ = false;
};

std::vector<std::uint8_t> readBytes(const fs::path& file, LoadBudget* budget) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw Error(file.string() + ": no such file");
  if (!fs::is_regular_file(status)) throw Error(file.string() + ": not a regular file");
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  if (budget) budget->charge(size, "");
  std::vector<std::uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw Error(file.string() + ": cannot be read to its end");
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> readWholeFile(const fs::path& file) { return readBytes(file, nullptr); }
std::vector<std::uint8_t> readWholeFile(const fs::path& file, LoadBudget& budget) {
  return readBytes(file, &budget);
}

void writeFileAtomically(const fs::path& file, std::span<const std::uint8_t> bytes) {
  TemporaryFile temporary(file);
  if (!temporary.write(bytes) || !temporary.renameTo(file)) {
    throw Error(file.string() + ": cannot be written: " + std::strerror(errno));
  }
}

}  // namespace saccade::core
