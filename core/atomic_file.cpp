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

AtomicFile::AtomicFile(const fs::path& file) : file_(file), temporary_(file) {
  static std::atomic<unsigned> count = 0;
  temporary_ += ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
  descriptor_ = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail();
  created_ = true;
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (created_) ::unlink(temporary_.c_str());
}

void AtomicFile::fail() const {
  throw Error(file_.string() + ": cannot be written: " + std::strerror(errno));
}

void AtomicFile::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  if (::close(std::exchange(descriptor_, -1)) != 0) fail();
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) fail();
  created_ = false;
}

void writeFileAtomically(const fs::path& file, std::span<const std::uint8_t> bytes) {
  AtomicFile whole(file);
  whole.write(bytes);
  whole.commit();
}

}  // namespace saccade::core
