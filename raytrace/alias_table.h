// Drawing from discrete distributions in constant time: A. J. Walker, "An Efficient Method for Generating
// Discrete Random Variables with General Distributions", ACM TOMS 3(3), 1977.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace saccade::raytrace {

/// Walker's alias table over weights >= 0; all zero = empty.
class AliasTable {
 public:
  static constexpr float kBelowOne = 0x1.fffffep-1f;  ///< the largest float below 1

  AliasTable() = default;
  explicit AliasTable(std::span<const double> weights);
  bool empty() const { return slots_.empty(); }
  /// u in [0, 1); `rest` gets a fresh number in [0, 1).
  std::uint32_t sample(float u, float& rest) const;
  float probability(std::uint32_t i) const { return slots_[i].probability; }
  double total() const { return total_; }

 private:
  struct Slot {
    float keep = 1;
    std::uint32_t alias = 0;
    float probability = 0;
  };
  std::vector<Slot> slots_;
  double total_ = 0;
};

}  // namespace saccade::raytrace
