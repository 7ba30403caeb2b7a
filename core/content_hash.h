// A 64-bit hash of content, for keys and checksums: not against malice.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace saccade::core {

/// Order matters; every number is hashed by its bits. Eight bytes at a time through a multiply-xorshift mix
/// with full avalanche (the finaliser of MurmurHash3 in each step).
class ContentHash {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof value);
    step(word);
  }

  void add(std::span<const std::uint8_t> bytes) {
    add(static_cast<std::uint64_t>(bytes.size()));
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, 8);
      step(word);
    }
    std::uint64_t rest = 0;
    if (at < bytes.size()) std::memcpy(&rest, bytes.data() + at, bytes.size() - at);
    step(rest);
  }

  void add(const std::string& text) {
    add(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }

  /// The bytes of numbers or of plain structures without padding, one after another.
  template <class Array>
  void addArray(const Array& values) {
    using T = std::remove_cvref_t<decltype(*values.data())>;
    static_assert(std::is_trivially_copyable_v<T>);
    add(std::span(reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)));
  }

  std::uint64_t value() const { return mix(state_); }

 private:
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 33)) * 0xFF51AFD7ED558CCDull;
    x = (x ^ (x >> 33)) * 0xC4CEB9FE1A85EC53ull;
    return x ^ (x >> 33);
  }
  void step(std::uint64_t word) {
    state_ = std::rotl(state_, 29) * 0x9E3779B97F4A7C15ull ^ mix(word + 0x2545F4914F6CDD1Dull);
  }

  std::uint64_t state_ = 0x6A09E667F3BCC909ull;
};

}  // namespace saccade::core
