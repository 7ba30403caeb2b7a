// A file of ours that ends with the hash of what comes before, written piece by piece.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

#include "core/atomic_file.h"
#include "core/content_hash.h"

namespace saccade::core {

/// Through a buffer, so that a file takes no second copy of what it holds. One thread at a time. Throws
/// core::Error as AtomicFile; nothing is there before commit().
class HashedFile {
 public:
  static constexpr std::size_t kPiece = std::size_t{1} << 20;  ///< bytes; each is hashed by itself

  explicit HashedFile(const std::filesystem::path& file) : file_(file) {}

  template <class T>
  void number(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw({reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  }
  void raw(std::span<const std::uint8_t> bytes);
  /// Writes the hash and puts the file in its place.
  void commit();

  /// The hash that a file with these bytes before it ends with.
  static std::uint64_t hashOf(std::span<const std::uint8_t> bytes);

 private:
  void flush();

  AtomicFile file_;
  ContentHash hash_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace saccade::core
