#include "core/hashed_file.h"

#include <algorithm>

namespace saccade::core {

void HashedFile::raw(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), kPiece - buffer_.size());
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    bytes = bytes.subspan(n);
    if (buffer_.size() == kPiece) flush();
  }
}

void HashedFile::flush() {
  hash_.add(buffer_);
  file_.write(buffer_);
  buffer_.clear();
}

void HashedFile::commit() {
  if (!buffer_.empty()) flush();
  const std::uint64_t sum = hash_.value();
  file_.write({reinterpret_cast<const std::uint8_t*>(&sum), sizeof sum});
  file_.commit();
}

std::uint64_t HashedFile::hashOf(std::span<const std::uint8_t> bytes) {
  ContentHash hash;
  for (std::size_t at = 0; at < bytes.size(); at += kPiece)
    hash.add(bytes.subspan(at, std::min(kPiece, bytes.size() - at)));
  return hash.value();
}

}  // namespace saccade::core
