#include "core/math/random.h"

namespace saccade::core {

std::uint32_t hashKey(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const std::uint64_t first = detail::mix64(std::uint64_t{a} << 32 | b);
  // The constant keeps (0, 0, 0, 0) from being a fixed point.
  const std::uint64_t both = detail::mix64((first ^ (std::uint64_t{c} << 32 | d)) + 0x9e3779b97f4a7c15ull);
  return static_cast<std::uint32_t>(both >> 32);
}

}  // namespace saccade::core
