// Whole files: read with the checks that user input needs, written so that a reader sees the old or the new
// one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/load_budget.h"

namespace saccade::core {

/// Throws core::Error unless `file` is a regular file (no folder, FIFO or device) that can be read. Any
/// thread.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& file);
/// As many bytes as `budget` has left at most; they stay charged.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& file, LoadBudget& budget);

/// A file written piece by piece beside its place, under a temporary name of its own: after a failure, a kill
/// or beside a second writer the old file or a new one is there, whole. One thread.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Without commit() nothing is left.
  ~AtomicFile();
  /// Throws core::Error.
  void write(std::span<const std::uint8_t> bytes);
  /// Puts the file in its place; nothing may be written afterwards. Throws core::Error.
  void commit();

 private:
  [[noreturn]] void fail() const;
  std::filesystem::path file_, temporary_;
  int descriptor_ = -1;
  bool created_ = false;
};

/// A whole AtomicFile. Throws core::Error, leaving no temporary file. Any thread.
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace saccade::core
