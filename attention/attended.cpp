#include "attention/attended.h"

#include <algorithm>
#include <cmath>

namespace saccade::attention {

void AttendedObjects::attend(std::uint32_t id, double seconds) {
  if (id != 0) since_[id] = seconds;
}

std::vector<float> AttendedObjects::at(double seconds, std::size_t entries) {
  const auto halfLives = [seconds](double since) {
    return std::max(0.0, seconds - since) / kHalfLifeSeconds;
  };
  std::erase_if(since_, [&](const auto& object) { return halfLives(object.second) >= kHalfLives; });
  std::vector<float> added;
  for (const auto& [id, since] : since_) {
    if (id >= entries) break;
    added.resize(entries, 0.0f);
    added[id] = kHeight * static_cast<float>(std::exp2(-halfLives(since)));
  }
  return added;
}

}  // namespace saccade::attention
