#include "raytrace/alias_table.h"

#include <algorithm>
#include <cmath>

namespace saccade::raytrace {

AliasTable::AliasTable(std::span<const double> weights) {
  for (double w : weights) total_ += w;
  if (!(total_ > 0) || !std::isfinite(total_)) {
    total_ = 0;
    return;
  }
  const std::size_t n = weights.size();
  slots_.resize(n);
  std::vector<double> scaled(n);
  std::vector<std::uint32_t> small, large;
  for (std::size_t i = 0; i < n; ++i) {
    slots_[i].probability = static_cast<float>(weights[i] / total_);
    scaled[i] = weights[i] / total_ * static_cast<double>(n);
    (scaled[i] < 1 ? small : large).push_back(static_cast<std::uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t s = small.back(), l = large.back();
    small.pop_back();
    slots_[s].keep = static_cast<float>(scaled[s]);
    slots_[s].alias = l;
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
}

std::uint32_t AliasTable::sample(float u, float& rest) const {
  const float scaled = std::min(u, kBelowOne) * static_cast<float>(slots_.size());
  const auto i = std::min(static_cast<std::uint32_t>(scaled), static_cast<std::uint32_t>(slots_.size() - 1));
  const float part = std::clamp(scaled - static_cast<float>(i), 0.0f, kBelowOne);
  const Slot& slot = slots_[i];
  if (part < slot.keep) {
    rest = std::min(part / slot.keep, kBelowOne);
    return i;
  }
  rest = std::min((part - slot.keep) / (1 - slot.keep), kBelowOne);
  return slot.alias;
}

}  // namespace saccade::raytrace
