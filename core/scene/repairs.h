// Counted repairs of a file: what was wrong and put right, each kind once with its number and first place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"

namespace saccade::core {

/// One thread at a time.
class Repairs {
 public:
  /// `what` reads on after its number: "material factors out of range were clamped".
  void add(const std::string& what, const std::string& element, std::uint64_t count = 1) {
    for (Kind& kind : kinds_) {
      if (kind.what != what) continue;
      kind.count += count;
      return;
    }
    kinds_.push_back({what, element, count});
  }
  /// "3 WHAT (first: ELEMENT)", in order of the first of each kind.
  void report(Warnings& warnings) const {
    for (const Kind& kind : kinds_)
      warnings.push_back(std::to_string(kind.count) + " " + kind.what + " (first: " + kind.first + ")");
  }

 private:
  struct Kind {
    std::string what, first;
    std::uint64_t count;
  };
  std::vector<Kind> kinds_;
};

}  // namespace saccade::core
