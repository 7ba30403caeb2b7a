// Reading the files of our own: numbers and arrays one after another, refused where they end too early.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace saccade::core {

class ByteReader {
 public:
  /// A refusal reads "`name`: this `kind` WHY; `advice`". `bytes` must stay valid.
  ByteReader(std::span<const std::uint8_t> bytes, std::string name, std::string kind, std::string advice)
      : rest_(bytes), name_(std::move(name)), kind_(std::move(kind)), advice_(std::move(advice)) {}

  /// T must be trivially copyable and hold any bits.
  template <class T>
  T number() {
    T value;
    take(&value, sizeof value);
    return value;
  }
  /// A count of 64 bits, then so many T.
  template <class T>
  std::vector<T> array() {
    const auto count = number<std::uint64_t>();
    if (count > rest_.size() / sizeof(T)) refuse("is cut off");
    std::vector<T> out(static_cast<std::size_t>(count));
    take(out.data(), out.size() * sizeof(T));
    return out;
  }
  std::span<const std::uint8_t> bytes(std::size_t count) {
    if (count > rest_.size()) refuse("is cut off");
    const std::span<const std::uint8_t> out = rest_.first(count);
    rest_ = rest_.subspan(count);
    return out;
  }
  /// Throws core::Error.
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(name_ + ": this " + kind_ + " " + why + "; " + advice_);
  }
  bool atEnd() const { return rest_.empty(); }

 private:
  void take(void* to, std::size_t count) {
    const std::span<const std::uint8_t> from = bytes(count);
    if (count > 0) std::memcpy(to, from.data(), count);
  }
  std::span<const std::uint8_t> rest_;
  std::string name_, kind_, advice_;
};

}  // namespace saccade::core
